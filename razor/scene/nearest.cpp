#include "razor/scene/nearest.h"

#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace razor {
namespace {

std::string_view without_dashes(std::string_view word) {
    return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

} // namespace

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

bool is_near(std::string_view word, std::string_view known) {
    const std::string_view a = without_dashes(word), b = without_dashes(known);
    const std::size_t shorter = std::min(a.size(), b.size());
    const std::size_t edits = shorter < 2 ? 0 : std::max<std::size_t>(1, shorter / 3);
    const auto alike = static_cast<std::size_t>(
        std::mismatch(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(shorter), b.begin()).first -
        a.begin());
    return static_cast<std::size_t>(edit_distance(a, b)) <= edits || (alike >= 3 && 3 * alike >= 2 * shorter);
}

std::string_view meant(std::string_view word, std::span<const std::string_view> known) {
    std::string_view out;
    int least = 0;
    for (const std::string_view one : known)
        if (is_near(word, one))
            if (const int edits = edit_distance(word, one); out.empty() || edits < least) {
                out = one;
                least = edits;
            }
    return out;
}

std::string or_known(std::string_view word, std::span<const std::string_view> known, std::string_view lead) {
    constexpr std::size_t most = 2000; // letters of the list
    const std::string list = printable(fmt::format("{}", fmt::join(known, ", ")), most);
    std::string begin(lead);
    if (const std::string_view one = meant(word, known); !one.empty())
        return fmt::format("did you mean '{}'? {}: {}", printable(one), begin, list);
    begin.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(begin.front())));
    return fmt::format("{}: {}", begin, list);
}

} // namespace razor
