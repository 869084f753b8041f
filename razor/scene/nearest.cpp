#include "razor/scene/nearest.h"

#include <algorithm>
#include <vector>

namespace razor {

int edit_distance(std::string_view a, std::string_view b) {
    a = a.substr(0, 64); // keys are short; garbage need not be compared whole
    b = b.substr(0, 64);
    const std::size_t width = b.size() + 1;
    std::vector<int> cost((a.size() + 1) * width);
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            int& best = cost[i * width + j];
            if (i == 0 || j == 0) {
                best = static_cast<int>(i + j);
                continue;
            }
            const int replaced = cost[(i - 1) * width + j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            best = std::min({replaced, cost[(i - 1) * width + j] + 1, cost[i * width + j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                best = std::min(best, cost[(i - 2) * width + j - 2] + 1);
            }
        }
    }
    return cost.back();
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
    return *std::min_element(known.begin(), known.end(), [&](std::string_view a, std::string_view b) {
        return edit_distance(word, a) < edit_distance(word, b);
    });
}

} // namespace razor
