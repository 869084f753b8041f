#include "analysis/metrics/hit_differences.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace analysis {
namespace {

const Channel& channel(const ImageFile& image, std::string_view name) {
    const Channel* const found = image.find(name);
    if (found == nullptr)
        throw ImageError("a picture has no layer pick; render it with --layers pick");
    return *found;
}

} // namespace

HitDifferences hit_differences(const ImageFile& picture, const ImageFile& reference) {
    if (picture.width != reference.width || picture.height != reference.height)
        throw ImageError("pictures to compare hits of differ in size; render both at one size");
    const Channel &z = channel(picture, "pick.Z"), &r = channel(reference, "pick.Z");
    const Channel &seen = channel(picture, "pick.instance"), &right = channel(reference, "pick.instance");
    HitDifferences out;
    out.pixels = z.bits.size();
    std::vector<double> errors;
    for (std::size_t i = 0; i < out.pixels; ++i) {
        if (seen.bits[i] != right.bits[i])
            ++out.wrong;
        else if (std::isfinite(r.value(i)) && std::isfinite(z.value(i)))
            errors.push_back(std::abs(z.value(i) - r.value(i)) / r.value(i));
    }
    if (errors.empty()) {
        out.mean_distance_error = out.median_distance_error = std::numeric_limits<double>::quiet_NaN();
        return out;
    }
    out.mean_distance_error =
        std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    out.median_distance_error = *middle;
    return out;
}

} // namespace analysis
