// What lies in each line of simulated memory: structures are the names of the address space's regions, and
// kernels note the level of what they place. Tiles share the map, on any number of host threads: what a tile
// notes counts for itself at once and for the others from the end of the window on, so that no report depends
// on which ran first.
#pragma once

#include "isa/address_space.h"
#include "sim/memory/traffic.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace sim {

/// A structure and a level of what lies in it, as a small number.
using LineKind = std::uint32_t;

class LineMap {
public:
    /// Lines are the L1s', of 2^line_shift bytes. Behind the regions lie so many bytes of page tables.
    LineMap(const isa::address_space& space, unsigned line_shift, std::uint64_t page_table_bytes = 0);
    /// What lies where, by name, without a frame memory. What is beyond `end` is of the last structure.
    struct Extent {
        std::uint64_t end; // of what begins where the one before it ends
        std::uint16_t structure;
    };
    LineMap(const std::vector<Extent>& extents, std::vector<std::string> structures, std::uint64_t end,
            unsigned line_shift);
    /// Where the last region ends.
    static std::uint64_t end_of(const isa::address_space& space);

    class Line {
    public:
        /// What it is to a tile.
        LineKind kind(std::uint32_t tile) const {
            const std::uint64_t w = kind_.load(std::memory_order_relaxed);
            const std::uint64_t noted_by = w >> noted_shift;
            return static_cast<LineKind>((noted_by == 0 || noted_by == tile + 1 ? w : w >> before_shift) &
                                         kind_mask);
        }
        /// From now on it is of this structure.
        void place(std::size_t structure) {
            const LineKind kind = kind_of(structure, 0);
            if (kind_.load(std::memory_order_relaxed) != kind)
                kind_.store(kind, std::memory_order_relaxed);
        }
        void touch(std::size_t column) {
            const std::uint64_t bit = std::uint64_t{1} << column;
            if ((touched_.load(std::memory_order_relaxed) & bit) == 0)
                touched_.fetch_or(bit, std::memory_order_relaxed);
        }

    private:
        friend class LineMap;
        static constexpr unsigned before_shift = 24, noted_shift = 48;
        static constexpr std::uint64_t kind_mask = (std::uint64_t{1} << before_shift) - 1;
        std::atomic<std::uint64_t> kind_{
            0}; // what it is; what it was when the window began; 1 + who noted it
        std::atomic<std::uint64_t> touched_{0}; // a bit a column
    };

    /// Null where no region is: there registers are spilled.
    Line* line(std::uint64_t address) {
        const std::size_t granule = address / isa::address_space::granule;
        return granule < granule_count_ ? &lines(granule)[line_in_granule(address)] : nullptr;
    }
    /// The host's caches get what is known of the line there, if anything is.
    void bring(std::uint64_t address) const {
        const std::size_t granule = address / isa::address_space::granule;
        if (granule < granule_count_)
            if (const Line* made = granules_[granule].lines.load(std::memory_order_acquire); made != nullptr)
                __builtin_prefetch(&made[line_in_granule(address)]);
    }
    /// From now on these bytes are of this level. Notes of a window are kept in `notes` until it ends.
    void note_level(std::uint64_t address, std::uint64_t bytes, int level, std::uint32_t tile,
                    std::vector<Line*>& notes);
    /// ... or of the level of the line at `other`, if it has one.
    void note_level_of(std::uint64_t address, std::uint64_t bytes, std::uint64_t other, std::uint32_t tile,
                       std::vector<Line*>& notes);
    /// The window has ended: a tile's notes count for all.
    static void publish(std::vector<Line*>& notes);

    static constexpr const char* page_tables = "page tables"; // the structure's name
    /// Where simulated memory ends and register spills begin.
    std::uint64_t spill_begin() const { return granule_count_ * isa::address_space::granule; }
    LineKind spill() const { return kind_of(structures_.size() - 1, 0); }
    const std::vector<std::string>& structures() const { return structures_; }
    std::size_t kind_count() const { return structures_.size() << level_bits; }
    static std::size_t structure_of(LineKind kind) { return kind >> level_bits; }
    static std::optional<int> level_of(LineKind kind);
    /// Lines of the structures but `spill`, by structure and by which columns touched them; longer ones, of
    /// so many (a power of two), likewise.
    std::vector<TouchedLines> touched(std::size_t together = 1) const;
    /// None has been touched so far.
    void forget_touched();

private:
    static constexpr unsigned level_bits = 8; // 0: none noted; levels beyond +-127 count as those
    static LineKind kind_of(std::size_t structure, std::uint32_t level_code) {
        return static_cast<LineKind>(structure << level_bits | level_code);
    }
    struct Granule {
        std::uint16_t structure = 0;
        std::atomic<Line*> lines{nullptr}; // none before the first use
    };
    Line* lines(std::size_t granule) {
        Line* made = granules_[granule].lines.load(std::memory_order_acquire);
        return made != nullptr ? made : make_lines(granule);
    }
    Line* make_lines(std::size_t granule);
    void check_structures() const;
    std::size_t line_in_granule(std::uint64_t address) const {
        return address % isa::address_space::granule >> line_shift_;
    }
    std::size_t lines_in_granule() const { return isa::address_space::granule >> line_shift_; }
    void note(std::uint64_t address, std::uint64_t bytes, std::uint32_t level_code, std::uint32_t tile,
              std::vector<Line*>& notes);

    unsigned line_shift_;
    std::vector<std::string> structures_; // in order of address; the last is `spill`
    std::size_t granule_count_ = 0;
    std::unique_ptr<Granule[]> granules_;
    std::mutex making_;
    std::vector<std::unique_ptr<Line[]>> made_;
};

} // namespace sim
