// What a tile notes of its references for a trace, until the recorder collects it between windows.
#pragma once

#include "isa/simulated/port.h"
#include "sim/core/sites.h"
#include "traces/reference.h"
#include "traces/sample.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

/// Where references are seen: those that cores make; what a level of caches misses, writes back, writes
/// through and prefetches; what memory is asked for.
struct TraceLevel {
    static constexpr unsigned core = 0, memory = ~0U; // else that of the L1 is 1, of the L2 2, ...
};

class TraceTap {
public:
    /// What is left out; shared by all tiles.
    struct Filter {
        unsigned level = TraceLevel::core;
        std::uint64_t begin = 0, end = ~std::uint64_t{0}; // cycles, from where a run begins to count
        double sample = 1;                                // of lines of ...
        unsigned line_shift = 0;                          // ... so many bytes
        std::vector<bool> structures, columns, streams;   // that are in
    };
    struct Noted {
        std::uint64_t time, address;
        std::uint32_t stream, size, site;
        std::uint16_t structure, column;
        traces::Kind kind;
        traces::Part part;
        std::uint32_t detail; // passing.h
        std::int32_t pixel;   // of the picture, for which it was; below 0: none
    };

    /// `all`: where tiles note what they do in one order, or null.
    TraceTap(const Filter& filter, TraceTap* all)
        : filter_(&filter), noted_(all != nullptr ? all->noted_ : &own_) {}
    TraceTap(const TraceTap&) = delete;
    TraceTap& operator=(const TraceTap&) = delete;

    bool is_at(unsigned level) const { return filter_->level == level && on_; }
    /// Whether it is of what caches pass on, of which level `level` (1: the L2) is asked by itself.
    bool is_above(unsigned level) const {
        return filter_->level != TraceLevel::core && filter_->level <= level && on_;
    }
    unsigned level() const { return filter_->level; }
    /// From this cycle on references are noted.
    void start(std::uint64_t cycle) {
        on_ = true;
        latest_ = 0;
        origin_ = cycle;
    }
    void note(const Noted& n) {
        // What others ask for has no time of its own.
        const std::uint64_t time = n.kind == traces::Kind::recall ? latest_ : n.time - origin_;
        const Filter& f = *filter_;
        if (time < f.begin || time >= f.end || !f.structures[n.structure] || !f.columns[n.column] ||
            !f.streams[n.stream])
            return;
        if (f.sample < 1 && traces::hash_of_line(n.address >> f.line_shift) >= f.sample)
            return;
        noted_->push_back(n);
        noted_->back().time = latest_ = time;
    }

    /// The number of a place in the source, for this tile; 0 is none.
    std::uint32_t site_number(isa::timing::site where) { return sites_.number(where) + 1; }
    const Sites& sites() const { return sites_; }
    std::vector<Noted>& noted() { return *noted_; }
    /// Of the access of an L1 at hand.
    std::uint32_t site = 0;

private:
    const Filter* filter_;
    bool on_ = false;
    std::uint64_t origin_ = 0, latest_ = 0;
    Sites sites_;
    std::vector<Noted>* noted_;
    std::vector<Noted> own_;
};

} // namespace sim
