#include "analysis/metrics/differences.h"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

/// Sets `differs` at every pixel whose bits differ.
ChannelDifference channel_difference(const Channel& a, const Channel& b, std::vector<bool>& differs) {
    ChannelDifference out;
    out.name = a.name;
    out.pixels = a.bits.size();
    double squares = 0;
    bool any = false;
    for (std::size_t i = 0; i < a.bits.size(); ++i) {
        const double value_a = a.value(i), value_b = b.value(i);
        if (a.bits[i] != b.bits[i]) {
            differs[i] = true;
            out.first = out.differing++ == 0 ? i : out.first;
        }
        if (!std::isfinite(value_a) || !std::isfinite(value_b)) {
            ++out.left_out;
            out.not_numbers_differing += a.bits[i] != b.bits[i] ? 1 : 0;
            continue;
        }
        const double difference = std::abs(value_a - value_b);
        squares += difference * difference;
        if (!any || difference > out.largest) {
            any = true;
            out.largest = difference;
            out.largest_at = i;
            out.a = value_a;
            out.b = value_b;
        }
    }
    out.rmse = any ? std::sqrt(squares / static_cast<double>(out.pixels - out.left_out)) : 0;
    return out;
}

} // namespace

bool Differences::identical() const {
    return same_size && only_in_a.empty() && only_in_b.empty() && stored_as_different_types.empty() &&
           pixels_differing == 0;
}

Differences differences(const ImageFile& a, const ImageFile& b) {
    Differences out;
    out.same_size = a.width == b.width && a.height == b.height;
    if (!out.same_size) {
        return out;
    }
    std::vector<bool> differs(static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height));
    for (const Channel& channel : a.channels) {
        const Channel* const other = b.find(channel.name);
        if (other == nullptr) {
            out.only_in_a.push_back(channel.name);
        } else if (other->kind != channel.kind) {
            out.stored_as_different_types.push_back(channel.name);
        } else {
            out.channels.push_back(channel_difference(channel, *other, differs));
        }
    }
    for (const Channel& channel : b.channels) {
        if (a.find(channel.name) == nullptr) {
            out.only_in_b.push_back(channel.name);
        }
    }
    out.pixels_differing = static_cast<std::size_t>(std::count(differs.begin(), differs.end(), true));
    return out;
}

} // namespace analysis
