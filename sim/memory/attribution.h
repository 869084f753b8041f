// Which traffic cell an access of a tile counts in: by what lies there (line_map.h) and by column, a kind of
// work and a phase. Every tile counts for itself.
#pragma once

#include "sim/memory/line_map.h"
#include "sim/memory/owner_costs.h"
#include "sim/trace/tap.h"

#include <cstdlib>
#include <memory>
#include <vector>

namespace sim {

class Attribution {
public:
    Attribution(LineMap& map, std::uint32_t tile, std::size_t columns);

    /// The cell of an access to an L1, whose line counts as touched.
    [[gnu::always_inline]] Traffic& touch(std::uint64_t address, std::size_t column) {
        if (unusual_) [[unlikely]] {
            column = plain_column(column);
            if (idle_)
                return spill_[column];
        }
        LineMap::Line* line = map_.line(address);
        if (line == nullptr)
            return spill_[column];
        line->touch(column);
        return cells(line->kind(tile_))[column];
    }
    /// The host's caches get what touch() will look at first.
    void bring(std::uint64_t address) const { map_.bring(address); }
    /// The cell of anything else that happens to the line there.
    Traffic& cell(std::uint64_t address, std::size_t column) {
        if (unusual_) [[unlikely]] {
            column = plain_column(column);
            if (idle_)
                return spill_[column];
        }
        LineMap::Line* line = map_.line(address);
        return line == nullptr ? spill_[column] : cells(line->kind(tile_))[column];
    }
    /// One of these there, which whoever it is for is charged with.
    void count(std::uint64_t address, std::uint64_t Traffic::*what, std::size_t column) {
        ++(cell(address, column).*what);
        if (unusual_ && owners_ != nullptr) [[unlikely]]
            owners_->count(tile_, column, what);
    }
    void note_level(std::uint64_t address, std::uint64_t bytes, int level) {
        if (!idle_)
            map_.note_level(address, bytes, level, tile_, notes_);
    }
    void note_level_of(std::uint64_t address, std::uint64_t bytes, std::uint64_t other) {
        if (!idle_)
            map_.note_level_of(address, bytes, other, tile_, notes_);
    }
    /// A line is asked of memory, or given to it.
    void count_memory_read(std::uint64_t address, std::size_t column) {
        count(address, &Traffic::memory_reads, column);
    }
    void count_memory_write(std::uint64_t address, std::size_t column) {
        count(address, &Traffic::memory_writes, column);
    }
    /// ... and so many bytes of it are there at cycle `t`. In the order in which memory gets them.
    void note_memory(traces::Kind kind, std::uint64_t address, std::uint32_t bytes, std::uint64_t t,
                     std::size_t column) {
        note(TraceLevel::memory, kind, address, bytes, t, column, tile_);
    }
    /// From now on nobody asks what belongs to what, until it is said again.
    void set_idle(bool on) {
        idle_ = on;
        unusual_ = idle_ || owners_ != nullptr || tap_ != nullptr;
    }
    /// Columns name parties there, to which misses and traffic of memory are charged.
    void charge(OwnerCosts& owners) {
        owners_ = &owners;
        unusual_ = true;
    }
    /// References of the tile are noted there, if any are. Columns name parties, or owners where none are
    /// charged.
    void trace(TraceTap& tap) {
        tap_ = &tap;
        unusual_ = true;
    }
    /// What happens at a level is noted for a trace of that level.
    void note(unsigned level, traces::Kind kind, std::uint64_t address, std::uint32_t bytes, std::uint64_t t,
              std::size_t column, std::uint32_t stream, std::uint32_t detail = 0) {
        if (notes(level)) [[unlikely]]
            note_always(kind, address, bytes, t, column, stream, level == 1 ? tap_->site : 0,
                        traces::Part::operation, detail);
    }
    bool notes(unsigned level) const { return tap_ != nullptr && tap_->is_at(level); }
    void note_always(traces::Kind kind, std::uint64_t address, std::uint32_t bytes, std::uint64_t t,
                     std::size_t column, std::uint32_t stream, std::uint32_t site, traces::Part part,
                     std::uint32_t detail = 0);
    std::uint32_t tile() const { return tile_; }
    std::uint64_t spill_begin() const { return map_.spill_begin(); }
    /// Between windows.
    void publish_notes() { LineMap::publish(notes_); }

    /// The sums of all tiles where anything happened, by structure, level and column.
    static std::vector<TrafficRow> traffic(const std::vector<const Attribution*>& tiles);

private:
    struct Free {
        void operator()(void* p) const { std::free(p); }
    };
    Traffic* cells(LineKind kind) {
        Traffic* c = by_kind_[kind];
        return c != nullptr ? c : make_cells(kind);
    }
    Traffic* make_cells(LineKind kind);

    LineMap& map_;
    std::uint32_t tile_;
    std::size_t columns_;
    std::unique_ptr<Traffic*[], Free> by_kind_; // null where nothing has happened
    std::vector<std::unique_ptr<Traffic[]>> made_;
    std::vector<LineMap::Line*> notes_;
    Traffic* spill_;
    bool idle_ = false;
    bool unusual_ = false; // idle, or columns name owners
    OwnerCosts* owners_ = nullptr;
    TraceTap* tap_ = nullptr;
};

} // namespace sim
