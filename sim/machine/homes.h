// Which tile answers for the shared words of a region of memory: the only one that has touched them so far,
// or the whole chip. A tile that is at home acts at once. Everybody else's operation waits for the end of the
// window, and changes where the region is at home from then on. So what a tile does within a window depends
// on no other tile.
#pragma once

#include "isa/address_space.h"

#include <cstdint>
#include <vector>

namespace sim {

class Homes {
public:
    Homes(const isa::address_space& space, std::int64_t tiles) {
        std::int32_t number = 0;
        for (const isa::region& r : space.regions()) {
            std::size_t end = (r.end + isa::address_space::granule - 1) / isa::address_space::granule;
            if (region_of_.size() < end)
                region_of_.resize(end, number);
            for (std::size_t i = r.begin / isa::address_space::granule; i < end; ++i)
                region_of_[i] = number;
            ++number;
        }
        home_.assign(static_cast<std::size_t>(number) + 1, tiles == 1 ? 0 : nobody);
    }

    enum class Use { looks, waits, writes };
    /// Whether a thread of `tile` may act on the word at once.
    bool acts_at_once(std::uint64_t address, std::uint32_t tile, Use use) const {
        std::int32_t home = home_[region(address)];
        return home == static_cast<std::int32_t>(tile) || (home == chip && use != Use::writes) ||
               (home == nobody && use == Use::looks);
    }
    /// A thread of `tile` acts between windows.
    void note(std::uint64_t address, std::uint32_t tile, Use use) {
        std::int32_t& home = home_[region(address)];
        if (home == nobody && use != Use::looks)
            home = static_cast<std::int32_t>(tile);
        else if (home >= 0 && home != static_cast<std::int32_t>(tile))
            home = chip;
    }
    bool is_chip(std::uint64_t address) const { return home_[region(address)] == chip; }

private:
    static constexpr std::int32_t nobody = -1, chip = -2;
    std::size_t region(std::uint64_t address) const {
        return static_cast<std::size_t>(region_of_[address / isa::address_space::granule]);
    }
    std::vector<std::int32_t> region_of_; // by granule
    std::vector<std::int32_t> home_;      // by region: a tile, nobody or chip
};

} // namespace sim
