#include "analysis/metrics/convolution.h"

#include <algorithm>

namespace analysis {

std::vector<float> convolve(const std::vector<float>& plane, int width, int height,
                            std::span<const float> row, std::span<const float> column) {
    const auto w = static_cast<std::size_t>(width);
    const auto h = static_cast<std::size_t>(height);
    const std::size_t radius = row.size() / 2;
    std::vector<float> rows(plane.size()), padded(w + 2 * radius);
    for (std::size_t y = 0; y < h; ++y) {
        const float* const in = plane.data() + w * y;
        std::fill_n(padded.begin(), radius, in[0]);
        std::copy_n(in, w, padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, in[w - 1]);
        float* const out = rows.data() + w * y;
        for (std::size_t i = 0; i < row.size(); ++i) {
            for (std::size_t x = 0; x < w; ++x) {
                out[x] += row[i] * padded[x + i];
            }
        }
    }
    std::vector<float> result(plane.size());
    const int reach = static_cast<int>(column.size() / 2);
    for (int y = 0; y < height; ++y) {
        float* const out = result.data() + w * static_cast<std::size_t>(y);
        for (int j = -reach; j <= reach; ++j) {
            const float weight = column[static_cast<std::size_t>(j + reach)];
            const float* const in =
                rows.data() + w * static_cast<std::size_t>(std::clamp(y + j, 0, height - 1));
            for (std::size_t x = 0; x < w; ++x) {
                out[x] += weight * in[x];
            }
        }
    }
    return result;
}

} // namespace analysis
