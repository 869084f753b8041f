// A core's data cache: write-back, write-allocate, misses held in MSHRs, evicted dirty lines in a write-back
// buffer. A line being filled counts as present; whoever hits it waits for the fill. Several machine accesses
// to one line may be counted by one call. Not modelled: the port of a fill; an evicted line whose fill is
// still on its way.
#pragma once

#include "sim/memory/l2.h"

#include <bit>

namespace sim {

class L1 {
public:
    L1(const Config& config, L2& l2, Attribution& attribution)
        : line_shift_(
              static_cast<unsigned>(std::countr_zero(static_cast<std::uint64_t>(config.l1.line_bytes)))),
          latency_(static_cast<std::uint64_t>(config.l1.latency)),
          array_(static_cast<std::size_t>(config.l1.size_bytes / (config.l1.ways * config.l1.line_bytes)),
                 static_cast<std::size_t>(config.l1.ways)),
          lines_(array_.entries()), mshrs_(static_cast<std::size_t>(config.l1.mshrs)),
          write_backs_(static_cast<std::size_t>(config.l1.write_back_buffer)), l2_(l2),
          attribution_(attribution) {}

    unsigned line_shift() const { return line_shift_; }

    /// `accesses` accesses to the line (number) at cycle `t`.
    Answer access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t, std::size_t phase) {
        Traffic& cell = attribution_.cell(line << line_shift_, phase);
        (write ? counters_.writes : counters_.reads) += accesses;
        (write ? cell.l1_writes : cell.l1_reads) += accesses;
        std::size_t entry = array_.find(line);
        if (entry != CacheArray::none) {
            counters_.hits += accesses;
            array_.touch(entry);
            Line& l = lines_[entry];
            l.dirty |= write;
            if (l.ready <= t + latency_)
                return {t + latency_, Cause::l1};
            ++counters_.hits_in_flight;
            return {l.ready, l.from};
        }
        counters_.hits += accesses - 1;
        ++counters_.misses;
        ++cell.l1_misses;
        return fill(line, write, t, phase);
    }
    /// Begins a fill if the line is absent and an MSHR is free.
    void prefetch(std::uint64_t line, cycle t, std::size_t phase);
    /// A shared word in the line was written: drops the line, writing it back if it is dirty.
    void invalidate(std::uint64_t line, cycle t, std::size_t phase);
    /// The line's contents are dead: it need not be written back.
    void discard(std::uint64_t line);
    CacheCounters& counters() { return counters_; }

private:
    struct Line {
        cycle ready = 0;
        Cause from = Cause::l1;
        bool dirty = false;
    };
    Answer fill(std::uint64_t line, bool write, cycle t, std::size_t phase);
    cycle write_back(std::size_t entry, cycle t, std::size_t phase);

    unsigned line_shift_;
    std::uint64_t latency_;
    CacheArray array_;
    std::vector<Line> lines_;
    Pool mshrs_, write_backs_;
    CacheCounters counters_;
    L2& l2_;
    Attribution& attribution_;
};

} // namespace sim
