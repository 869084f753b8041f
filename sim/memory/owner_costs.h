// What work and traffic cost whom they were for. Kernels say of each lane whom it works for, a number of
// theirs (isa/simulated/port.h), such as a pixel's. A party is the owners of a thread's active lanes: what
// the thread and the lines that it asks for cost counts for its party, and is shared evenly among the party's
// lanes when the run is over, in whole numbers that sum to what was counted. What a request brings on later
// (a line from memory, what that evicts there) is its party's too. Work counts when it is accounted for: a
// wait for what was asked for earlier is who waits'. Nobody: whatever no owner was named for, such as
// queues, refits, ends of frames, and threads without work.
#pragma once

#include "sim/core/stalls.h"
#include "sim/memory/traffic.h"

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace sim {

/// Of one thread, in a column.
struct ThreadCost {
    std::uint64_t cycles = 0, stalled = 0, waiting = 0, instructions = 0;
};
struct OwnerCost {
    ThreadCost thread;
    Traffic traffic; // misses, and memory's reads and writes, alone
};

/// A figure of it.
struct OwnerFigure {
    std::string name;
    std::uint64_t ThreadCost::*of_thread = nullptr; // or
    std::uint64_t Traffic::*of_traffic = nullptr;
    const char* meaning = "";

    std::uint64_t of(const OwnerCost& c) const {
        return of_thread != nullptr ? c.thread.*of_thread : c.traffic.*of_traffic;
    }
};
/// Of a machine with so many levels of caches.
std::vector<OwnerFigure> owner_figures(unsigned cache_levels);

/// A figure summed over owners; `builds`: of these. Whatever else there was is nobody's.
struct OwnerSum {
    std::string name;
    std::uint64_t owners = 0, builds = 0, nobody = 0;
};

/// A column of who asks for something: that of traffic.h, and whose it is above these bits.
inline constexpr unsigned column_bits = 16;
constexpr std::size_t plain_column(std::size_t column) {
    return column & ((std::size_t{1} << column_bits) - 1);
}

/// The same of who is known by one owner alone, of a number from 0 on, without a party.
constexpr std::size_t column_of_owner(std::int32_t owner) {
    return static_cast<std::size_t>(owner + std::int64_t{1}) << column_bits;
}
constexpr std::int32_t owner_of_column(std::size_t column) {
    return static_cast<std::int32_t>(static_cast<std::int64_t>(column >> column_bits) - 1);
}

/// Tiles use it side by side, each for its own parties; between windows all are counted for.
class OwnerCosts {
public:
    /// `builds`: by phase, whether work counts as building too; none does where it is missing.
    explicit OwnerCosts(std::vector<bool> builds) : builds_(std::move(builds)) {}

    // --- by the machine
    void begin(std::size_t tiles, std::size_t lanes, std::size_t phases);
    /// What has been counted so far does not count.
    void forget();
    /// The party, in the bits above a column, of a thread of the tile: owner[i] for each lane i.
    std::size_t party(std::size_t tile, const std::int32_t* owner, std::uint64_t lanes);
    /// ... those of its owners that these lanes have; the same one if there are none.
    std::size_t narrowed(std::size_t party, std::uint64_t lanes);
    /// The owner of the first lane of a column's party; -1: nobody.
    std::int32_t first_owner(std::size_t column) const;
    /// In the tile, whoever it is for.
    void count(std::size_t tile, std::size_t column, std::uint64_t Traffic::*what) {
        ++(cost(tile, column).traffic.*what);
    }
    void count(std::size_t tile, std::size_t column, const ThreadCost& what);

    // --- when the run is over
    /// Calls visit(owner, amount) for each share of the figure, any number of times an owner.
    void share(const OwnerFigure& figure, bool builds_alone,
               const std::function<void(std::int32_t owner, std::uint64_t amount)>& visit) const;
    OwnerSum sum(const OwnerFigure& figure) const;

private:
    struct Party {
        std::size_t block = 0;    // whose owners its lanes have
        std::uint64_t lanes = 0;  // active; none: nobody
        OwnerCost builds, others; // by phase
    };
    struct Key {
        std::size_t block;
        std::uint64_t lanes;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& k) const {
            return (k.block * 0x9e3779b97f4a7c15U) ^ (k.lanes * 0xc2b2ae3d27d4eb4fU >> 7U);
        }
    };
    struct OfTile {
        std::vector<std::int32_t> owners; // of blocks: packets' owners, block after block
        std::vector<Party> parties;
        std::unordered_map<Key, std::size_t, Hash> known;
    };
    /// Of a party's number in its tile; above them is the tile's.
    static constexpr unsigned number_bits = 32;
    static std::size_t tile_of(std::size_t party) { return party >> (column_bits + number_bits); }
    static std::size_t number_of(std::size_t party) {
        return party >> column_bits & ((std::size_t{1} << number_bits) - 1);
    }
    std::size_t party_of(std::size_t tile, const Key& key);
    OwnerCost& cost(std::size_t tile, std::size_t column);

    std::vector<bool> builds_;
    std::size_t lanes_ = 0, phases_ = 1;
    std::vector<OfTile> tiles_; // each one's first party is nobody
};

} // namespace sim
