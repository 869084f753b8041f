// A core's data cache: write-back, write-allocate, misses held in MSHRs, evicted dirty lines in a write-back
// buffer. A line being filled counts as present; whoever hits it waits for the fill. Several machine accesses
// to one line may be counted by one call. Not modelled: the port of a fill; that a line which must make room
// before it has come would still be on its way.
#pragma once

#include "sim/memory/l2.h"
#include "sim/memory/pool.h"

#include <bit>

namespace sim {

class L1 {
public:
    L1(const Config& config, L2& l2, Tickets& tickets, Attribution& attribution)
        : line_shift_(
              static_cast<unsigned>(std::countr_zero(static_cast<std::uint64_t>(config.l1.line_bytes)))),
          latency_(static_cast<std::uint64_t>(config.l1.latency)),
          array_(static_cast<std::size_t>(config.l1.size_bytes / (config.l1.ways * config.l1.line_bytes)),
                 static_cast<std::size_t>(config.l1.ways)),
          mshrs_(static_cast<std::size_t>(config.l1.mshrs), tickets),
          write_backs_(static_cast<std::size_t>(config.l1.write_back_buffer), tickets), tickets_(tickets),
          l2_(l2), attribution_(attribution) {}

    unsigned line_shift() const { return line_shift_; }

    /// `accesses` accesses to the line (number) at cycle `t`.
    Answer access(std::uint64_t line, bool write, std::uint32_t accesses, cycle t, std::size_t column) {
        CacheArray::Entry entry = array_.find(line);
        Answer answer{t + latency_, Cause::l1};
        if (entry != CacheArray::none) {
            counters_.hits += accesses;
            array_.touch(entry);
            if (write)
                array_.set_dirty(entry, true);
            if (array_.in_flight(entry)) [[unlikely]]
                answer = in_flight(entry, line, answer);
        } else {
            answer = fill(line, write, t, column);
            if (answer.retry != 0)
                return answer;
            counters_.hits += accesses - 1;
            ++counters_.misses;
            ++attribution_.cell(line << line_shift_, column).l1_misses;
        }
        Traffic& cell = attribution_.touch(line << line_shift_, column);
        (write ? counters_.writes : counters_.reads) += accesses;
        (write ? cell.l1_writes : cell.l1_reads) += accesses;
        return answer;
    }
    /// Begins a fill if the line is absent and an MSHR is free.
    void prefetch(std::uint64_t line, cycle t, std::size_t column);
    /// A shared word in the line was written: drops the line, writing it back if it is dirty.
    void invalidate(std::uint64_t line, cycle t, std::size_t column);
    /// The line's contents are dead: it need not be written back.
    void discard(std::uint64_t line);
    /// The frame is over: `keep(address)` says which dirty lines are written back; all others are dropped.
    template <class Keep> void finish(cycle t, std::size_t column, Keep keep) {
        array_.for_each([&](CacheArray::Entry e) {
            if (!array_.dirty(e))
                return;
            if (keep(array_.line(e) << line_shift_))
                write_back(e, t, column);
            else
                ++counters_.dropped;
            array_.set_dirty(e, false);
        });
    }
    CacheCounters& counters() { return counters_; }
    const CacheCounters& counters() const { return counters_; }

private:
    Answer in_flight(CacheArray::Entry entry, std::uint64_t line, Answer present);
    Answer fill(std::uint64_t line, bool write, cycle t, std::size_t column);
    void write_back(CacheArray::Entry entry, cycle t, std::size_t column);

    unsigned line_shift_;
    std::uint64_t latency_;
    CacheArray array_;
    Pool mshrs_, write_backs_;
    CacheCounters counters_;
    Tickets& tickets_;
    L2& l2_;
    Attribution& attribution_;
};

} // namespace sim
