#include "sim/network/topology.h"

#include <fmt/core.h>

#include <algorithm>

namespace sim {
namespace {

/// The least divisor of n that is no less than its square root.
std::size_t near_square(std::size_t n) {
    std::size_t columns = 1;
    while (columns * columns < n || n % columns != 0)
        ++columns;
    return columns;
}

} // namespace

Topology::Topology(const Config& c)
    : kind_(c.network.topology == "ideal"      ? Kind::ideal
            : c.network.topology == "crossbar" ? Kind::crossbar
            : c.network.topology == "ring"     ? Kind::ring
            : c.network.topology == "bus"      ? Kind::bus
                                               : Kind::mesh),
      nodes_(wide(c.chip.tiles)), channels_(wide(c.memory.channels)) {
    const unsigned last = c.cache_levels() - 1;
    if (c.beyond_tiles(last)) {
        sharing_ = wide(c.cores_sharing(last) / c.chip.cores);
        caches_ = nodes_ / sharing_;
        banks_ = wide(c.cache(last).banks);
        level_ = last + 1;
    }
    for (std::size_t t = 0; t < nodes_; ++t)
        node_.push_back(t);
    for (std::size_t cache = 0; cache < caches_; ++cache)
        for (std::size_t b = 0; b < banks_; ++b)
            node_.push_back(cache * sharing_ + b * sharing_ / banks_);
    for (std::size_t ch = 0; ch < channels_; ++ch)
        node_.push_back(ch * nodes_ / channels_);
    const auto add = [this](std::size_t from, std::size_t to) {
        name_.push_back(fmt::format("router {} to {}", from, to));
        ends_.emplace_back(from, to);
    };
    if (kind_ == Kind::ring && nodes_ > 1) {
        for (std::size_t n = 0; n < nodes_; ++n)
            add(n, (n + 1) % nodes_);
        for (std::size_t n = 0; n < nodes_; ++n)
            add(n, (n + nodes_ - 1) % nodes_);
    }
    if (kind_ == Kind::mesh) {
        columns_ = c.network.columns != 0 ? wide(c.network.columns) : near_square(nodes_);
        const auto along_rows = [&](std::size_t from, std::size_t to) {
            for (std::size_t n = 0; n < nodes_; ++n)
                if (n % columns_ + 1 != columns_)
                    add(n + from, n + to);
        };
        const auto along_columns = [&](std::size_t from, std::size_t to) {
            for (std::size_t n = 0; n + columns_ < nodes_; ++n)
                add(n + from, n + to);
        };
        along_rows(0, 1);
        along_rows(1, 0);
        along_columns(0, columns_);
        along_columns(columns_, 0);
    }
    if (kind_ == Kind::bus) {
        buses_ = wide(c.network.buses);
        for (std::size_t b = 0; b < buses_; ++b)
            name_.push_back(fmt::format("bus {}", b));
    }
    between_ = name_.size();
}

Topology::Step Topology::ring_step(std::size_t at, std::size_t end) const {
    const std::size_t up = (end + nodes_ - at) % nodes_, down = nodes_ - up;
    if (up < down || (up == down && at % 2 == 0)) // as long both ways: it has not left its first node
        return {2 * units() + at, (at + 1) % nodes_};
    return {2 * units() + nodes_ + at, (at + nodes_ - 1) % nodes_};
}

/// Links in the order of the constructor: rows there and back, columns there and back.
Topology::Step Topology::mesh_step(std::size_t at, std::size_t end) const {
    const std::size_t x = at % columns_, row = at / columns_, wanted = end % columns_;
    const std::size_t in_rows = (columns_ - 1) * rows(), in_columns = nodes_ - columns_;
    const std::size_t first = 2 * units() + row * (columns_ - 1) + x;
    if (x < wanted)
        return {first, at + 1};
    if (x > wanted)
        return {first + in_rows - 1, at - 1};
    const std::size_t second = 2 * units() + 2 * in_rows + at;
    return at < end ? Step{second, at + columns_} : Step{second + in_columns - columns_, at - columns_};
}

std::size_t Topology::hops(std::size_t from, std::size_t to) const {
    if (kind_ == Kind::ideal || kind_ == Kind::crossbar)
        return kind_ == Kind::crossbar ? 1 : 0;
    std::size_t count = 0;
    walk(from, to, [&count](std::size_t) { ++count; });
    return count;
}

std::string Topology::unit_name(std::size_t unit) const {
    if (unit < nodes_)
        return fmt::format("tile {}", unit);
    unit -= nodes_;
    if (unit >= caches_ * banks_)
        return fmt::format("channel {}", unit - caches_ * banks_);
    return caches_ == 1 ? fmt::format("L{} bank {}", level_, unit)
                        : fmt::format("L{} {} bank {}", level_, unit / banks_, unit % banks_);
}

std::string Topology::link_name(std::size_t link) const {
    if (link < units())
        return "from " + unit_name(link);
    if (link < 2 * units())
        return "to " + unit_name(link - units());
    return name_[link - 2 * units()];
}

std::size_t Topology::bisection() const {
    if (kind_ == Kind::bus)
        return std::max<std::size_t>(1, buses_ / 2);
    if (kind_ != Kind::ring && kind_ != Kind::mesh)
        return units() / 2;
    if (nodes_ == 1)
        return 0;
    if (kind_ == Kind::ring)
        return 2;
    const auto cut = [this](bool odd) { // the least of the dimensions that this can halve
        std::size_t least = nodes_;
        for (const auto& [length, links] : {std::pair(columns_, rows()), std::pair(rows(), columns_)})
            if (length > 1 && (odd || length % 2 == 0))
                least = std::min(least, links);
        return least;
    };
    return nodes_ % 2 == 0 ? cut(false) : cut(true);
}

} // namespace sim
