#include "analysis/image_compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

const Channel* find(const ImageFile& image, const std::string& name) {
    const auto found = std::find_if(image.channels.begin(), image.channels.end(),
                                    [&](const Channel& channel) { return channel.name == name; });
    return found == image.channels.end() ? nullptr : &*found;
}

/// One line about a channel that differs; empty where it does not.
std::string channel_report(const Channel& a, const Channel& b, std::size_t width) {
    std::size_t count = 0, first = 0, worst = 0;
    double largest = -1;
    for (std::size_t i = 0; i < a.bits.size(); ++i) {
        if (a.bits[i] == b.bits[i]) {
            continue;
        }
        first = count++ == 0 ? i : first;
        const double difference = std::abs(a.value(i) - b.value(i));
        if (std::isnan(difference) ? !std::isnan(largest) : difference > largest) {
            largest = difference; // a NaN on one side is the largest of all
            worst = i;
        }
    }
    if (count == 0) {
        return {};
    }
    return fmt::format("{}: {} of {} pixels differ, first at ({}, {}); largest difference {:.9g} at ({}, "
                       "{}): {:.9g} and {:.9g}\n",
                       a.name, count, a.bits.size(), first % width, first / width, largest, worst % width,
                       worst / width, a.value(worst), b.value(worst));
}

} // namespace

Comparison compare(const ImageFile& a, const ImageFile& b) {
    Comparison result;
    if (a.width != b.width || a.height != b.height) {
        result.report =
            fmt::format("sizes differ: {} x {} and {} x {}\n", a.width, a.height, b.width, b.height);
        result.identical = false;
        return result;
    }
    for (const Channel& channel : a.channels) {
        const Channel* const other = find(b, channel.name);
        if (other == nullptr) {
            result.report += fmt::format("{}: only in the first picture\n", channel.name);
        } else if (other->kind != channel.kind) {
            result.report += fmt::format("{}: stored as different types\n", channel.name);
        } else {
            result.report += channel_report(channel, *other, static_cast<std::size_t>(a.width));
        }
    }
    for (const Channel& channel : b.channels) {
        if (find(a, channel.name) == nullptr) {
            result.report += fmt::format("{}: only in the second picture\n", channel.name);
        }
    }
    result.identical = result.report.empty();
    if (result.identical) {
        result.report = fmt::format("identical: {} x {}, {} planes\n", a.width, a.height, a.channels.size());
    }
    return result;
}

} // namespace analysis
