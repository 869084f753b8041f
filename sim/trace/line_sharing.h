// Which lines cores share: over a run by what they access, and at once by what their caches hold. Looks at
// the references of cores as a trace has them (recorder.h), in its order, and every so many cycles at the
// caches of the machine.
//
// Transfers and invalidations are what the cores' data take wherever caches are private, however large they
// are and whether the machine keeps them coherent or not (what it does of its own is in the report's
// `coherence`): a line moves when a core accesses what another one has written since it last did, and a write
// takes away all copies that others have read or written since the write before. Not looked at: prefetches;
// order within a window between tiles, which are taken one after the other.
#pragma once

#include "sim/machine/report.h"
#include "sim/trace/tap.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace sim {

class LineSharing {
public:
    /// Caches are looked at every so many cycles, at ends of windows.
    explicit LineSharing(std::uint64_t interval) : interval_(interval) {}

    void begin(const Config& config, std::size_t structures);
    /// From this cycle on the run counts.
    void start(cycle t) { next_ = t + interval_; }
    /// A reference of a core; others are passed over.
    void note(const TraceTap::Noted& n);
    bool due(cycle t) const { return t >= next_; }
    /// holds(level, core, address): whether the cache of a level that this core uses has the line.
    template <class Holds> void look(cycle t, Holds holds) {
        next_ = t + interval_;
        ++looks_;
        std::vector<std::uint64_t> seen;
        for (const Line& line : lines_)
            for (std::size_t level = 0; level < sharing_.size(); ++level) {
                std::size_t copies = 0;
                seen.clear();
                for (std::uint32_t u = line.users; u != none; u = users_[u].next) {
                    const std::uint64_t cache = users_[u].core / sharing_[level];
                    if (std::find(seen.begin(), seen.end(), cache) != seen.end())
                        continue;
                    seen.push_back(cache);
                    copies += holds(static_cast<unsigned>(level), users_[u].core, line.number << line_shift_)
                                  ? 1
                                  : 0;
                }
                if (copies != 0)
                    add(held_[level][line.structure], copies, 1);
            }
    }

    /// What lies in a structure's lines: those that were first accessed as such.
    struct Structure {
        std::uint64_t lines = 0;
        std::vector<std::uint64_t> by_cores;   // lines that one core accesses, that two do, ...
        std::vector<std::uint64_t> written_by; // ... and that any of them writes
        std::uint64_t bytes_read = 0, bytes_read_by_several = 0;
        std::uint64_t transfers = 0, invalidations = 0;
    };
    std::vector<Structure> structures() const;
    /// What a core accesses.
    struct Footprint {
        std::uint64_t lines = 0, alone = 0; // nobody else accesses these
    };
    std::vector<Footprint> footprints() const;
    /// Lines of a structure that one cache of a level holds, that two do, ...: sums over looks().
    const std::vector<std::uint64_t>& held(unsigned level, std::size_t structure) const {
        return held_[level][structure];
    }
    unsigned levels() const { return static_cast<unsigned>(sharing_.size()); }
    std::uint64_t looks() const { return looks_; }
    std::uint64_t interval() const { return interval_; }
    std::uint64_t line_bytes() const { return std::uint64_t{1} << line_shift_; }

    /// Throws std::logic_error where lines are not those that the report says were touched, structure by
    /// structure, or sums over cores are not sums over lines.
    void check(const Report& report) const;

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct User {
        std::uint32_t core, next;
        std::uint64_t read = 0; // 64ths of the line
        bool latest = false;    // has it as it was written last
    };
    struct Line {
        std::uint64_t number;
        std::uint32_t structure, users = none, writer = none; // who wrote it last
        bool written = false;
        std::uint64_t read = 0, read_by_several = 0; // 64ths of the line
    };
    static void add(std::vector<std::uint64_t>& counts, std::size_t copies, std::uint64_t n) {
        if (counts.size() < copies)
            counts.resize(copies);
        counts[copies - 1] += n;
    }
    void access(std::uint64_t line, std::uint64_t parts, std::uint32_t structure, std::uint32_t core,
                bool reads, bool writes);
    User& user_of(Line& line, std::uint32_t core);

    std::uint64_t interval_;
    cycle next_ = 0;
    std::uint64_t looks_ = 0;
    unsigned line_shift_ = 6, part_shift_ = 0;
    std::uint32_t threads_ = 1;
    std::size_t cores_ = 1, structure_count_ = 0;
    std::vector<std::uint64_t> sharing_; // by level within tiles: cores of a cache
    std::unordered_map<std::uint64_t, std::uint32_t> index_;
    std::vector<Line> lines_;
    std::vector<User> users_;
    std::vector<std::uint64_t> transfers_, invalidations_;      // by structure
    std::vector<std::vector<std::vector<std::uint64_t>>> held_; // by level and structure
};

} // namespace sim
