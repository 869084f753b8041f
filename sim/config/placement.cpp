#include "sim/config/placement.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <stdexcept>

namespace sim {
namespace {

/// A number from 1, or 0 where the text is none.
integer group_size(const std::string& text) {
    integer n = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, n);
    return error == std::errc{} && stop == end && n > 0 ? n : 0;
}

} // namespace

Placement::Placement(const ChipConfig& chip)
    : Placement(chip.tiles, chip.cores, chip.threads, chip.placement == "pack") {}

Place Placement::of(integer worker) const {
    if (packed_)
        return {worker / threads_ / cores_, worker / threads_ % cores_, worker % threads_};
    return {worker % tiles_, worker / tiles_ % cores_, worker / tiles_ / cores_};
}

std::vector<int> Placement::trees(int workers, const std::string& share) const {
    const integer n = group_size(share);
    if (n == 0 && share != "chip" && share != "tile" && share != "core" && share != "worker")
        throw std::invalid_argument("unknown sharing of kd-trees: " + share);
    std::vector<int> order(static_cast<std::size_t>(workers)); // by hardware thread
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return number(of(a)) < number(of(b)); });

    std::vector<int> tree(order.size());
    integer group = -1;
    int last = -1;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Place p = of(order[i]);
        const integer mine = n > 0             ? static_cast<integer>(i) / n
                             : share == "chip" ? 0
                             : share == "tile" ? p.tile
                             : share == "core" ? p.tile * cores_ + p.core
                                               : static_cast<integer>(i);
        if (mine != group)
            ++last;
        group = mine;
        tree[static_cast<std::size_t>(order[i])] = last;
    }
    return tree;
}

std::vector<int> Placement::places(int workers) const {
    std::vector<int> place;
    for (int w = 0; w < workers; ++w)
        place.push_back(static_cast<int>(number(of(w))));
    return place;
}

} // namespace sim
