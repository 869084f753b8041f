#include "sim/network/ways.h"

#include <algorithm>
#include <bit>

namespace sim {
namespace {

std::uint64_t flits(const NetworkConfig& c, integer bytes) {
    return static_cast<std::uint64_t>(flits_of(c, bytes));
}

} // namespace

Ways::Ways(const Config& c, const cycle& earliest, std::uint64_t disorder)
    : ideal_(c.network.ideal()), network_(c, earliest), mapping_(c.memory),
      line_shift_(
          static_cast<unsigned>(std::countr_zero(static_cast<std::uint64_t>(c.last_cache().line_bytes)))),
      homes_(static_cast<std::size_t>(c.beyond_tiles(c.cache_levels() - 1) ? c.last_cache().banks
                                                                           : c.memory.channels)),
      banks_(c.beyond_tiles(c.cache_levels() - 1)),
      line_mask_(static_cast<std::uint64_t>(c.last_cache().line_bytes) - 1), disorder_(disorder) {}

std::size_t Ways::bank(std::size_t cache, std::uint64_t address) const {
    const Topology& t = network_.topology();
    return t.bank(cache, (address >> line_shift_) % t.banks());
}

std::size_t Ways::source(Asker who, std::uint64_t address) const {
    return who.kind == Asker::tile ? network_.topology().tile(who.number) : bank(who.number, address);
}

std::size_t Ways::target(Asker who, std::uint64_t address) const {
    const Topology& t = network_.topology();
    if (who.kind == Asker::tile && t.caches() != 0)
        return bank(t.cache_of(who.number), address);
    return t.channel(mapping_.locate(address & ~line_mask_).channel);
}

std::size_t Ways::home(std::uint64_t address) const {
    return banks_ ? (address >> line_shift_) % homes_ : mapping_.locate(address & ~line_mask_).channel;
}

cycle Ways::reach(const Leg& leg, cycle t) {
    if (ideal_)
        return t;
    const cycle there = network_.send(leg, t);
    return leg.to < network_.topology().channel(0) ? there : in_order(there);
}

Ways::Shortest Ways::shortest(const Config& c) {
    if (c.network.ideal())
        return {};
    const Topology t(c);
    const std::size_t first = t.caches() != 0 ? t.bank(0, 0) : t.channel(0);
    const std::size_t end = t.caches() != 0 ? t.channel(0) : t.units();
    std::size_t hops = ~std::size_t{0};
    for (std::size_t tile = 0; tile < t.tiles() && hops != 0; ++tile)
        for (std::size_t to = first; to < end; ++to)
            hops = std::min(hops, t.hops(tile, to));
    const std::uint64_t way = hops * static_cast<std::uint64_t>(c.network.hop_cycles);
    const integer line = c.cache(c.tile_levels() - 1).line_bytes;
    const std::uint64_t last_link = flits(c.network, c.network.reply_bytes + line);
    return {way + flits(c.network, c.network.request_bytes), way + last_link, last_link};
}

} // namespace sim
