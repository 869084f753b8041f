#include "sim/network/figures.h"

#include "sim/network/topology.h"

#include <algorithm>

namespace sim {
namespace {

/// Hops of all who ask to all whom they may ask.
class Mean {
public:
    void add(std::size_t hops) {
        sum_ += real(hops);
        ++count_;
    }
    double hops() const { return sum_ / std::max(1.0, count_); }
    /// Of a line, there and back.
    double cycles(const NetworkConfig& c, integer line) const {
        return 2 * hops() * real(c.hop_cycles) +
               real(flits_of(c, c.request_bytes) + flits_of(c, c.reply_bytes + line));
    }

private:
    double sum_ = 0, count_ = 0;
};

} // namespace

NetworkFigures network_figures(const Config& c) {
    NetworkFigures f;
    if (c.network.ideal())
        return f;
    const Topology t(c);
    f.link_bytes_per_second = real(c.network.link_bytes) * 1e12 / real(c.chip.clock_ps);
    f.bisection_bytes_per_second = f.link_bytes_per_second * real(t.bisection());
    Mean from_tiles, from_caches;
    for (std::size_t tile = 0; tile < t.tiles(); ++tile)
        if (t.caches() != 0)
            for (std::size_t bank = 0; bank < t.banks(); ++bank)
                from_tiles.add(t.hops(t.tile(tile), t.bank(t.cache_of(tile), bank)));
        else
            for (std::size_t channel = 0; channel < t.channels(); ++channel)
                from_tiles.add(t.hops(t.tile(tile), t.channel(channel)));
    for (std::size_t cache = 0; cache < t.caches(); ++cache)
        for (std::size_t bank = 0; bank < t.banks(); ++bank)
            for (std::size_t channel = 0; channel < t.channels(); ++channel)
                from_caches.add(t.hops(t.bank(cache, bank), t.channel(channel)));
    f.hops = from_tiles.hops();
    f.cycles = from_tiles.cycles(c.network, c.cache(c.tile_levels() - 1).line_bytes);
    f.memory_cycles = t.caches() != 0 ? from_caches.cycles(c.network, c.last_cache().line_bytes) : 0;
    return f;
}

} // namespace sim
