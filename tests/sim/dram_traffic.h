// Requests for a memory by itself: one core cycle is one memory clock and the controller takes no time, so
// that what comes back are memory clocks.
#pragma once

#include "sim/config/memory_presets.h"
#include "sim/memory/dram_streams.h"
#include "sim/memory/memory.h"

#include <functional>
#include <queue>
#include <random>

namespace sim::test {

inline Config memory_of(const std::string& preset, const std::function<void(MemoryConfig&)>& change = {}) {
    Config c;
    apply_memory_preset(c, preset);
    if (change)
        change(c.memory);
    c.chip.clock_ps = c.memory.clock_ps;
    c.memory.controller_cycles = 0;
    check_consistency(c, "test");
    return c;
}

using Request = DramRequest;
using Source = DramStream;

/// Lines anywhere in the memory.
inline Source random_lines(std::uint64_t lines, double writes = 0, unsigned seed = 1) {
    return [random = std::mt19937_64(seed), lines, writes]() mutable {
        Request r{random() % lines * 64};
        r.write = writes > 0 && static_cast<double>(random() % 1000) < 1000 * writes;
        return r;
    };
}
/// One line after the other, or every n-th byte.
inline Source stream(std::uint64_t stride = 64) {
    return [next = std::uint64_t{0}, stride]() mutable {
        next += stride;
        return Request{next - stride};
    };
}

struct Outcome {
    double clocks = 0, lines = 0, latency = 0; // latency: mean, in clocks
    MemoryCounters counters;
    std::vector<MemoryCounters> by_rank;
    std::vector<DramCommand> log;

    double bytes_per_clock() const { return 64 * lines / clocks; }
    /// In GB/s.
    double bandwidth(const Config& c) const {
        return bytes_per_clock() * 1e3 / static_cast<double>(c.memory.clock_ps);
    }
};
inline double peak(const Config& c) { // bytes a clock
    return static_cast<double>(c.memory.channels * c.memory.bus_bytes * c.memory.transfers_per_clock);
}
/// The part of the time in which a rank is not refreshed.
inline double awake(const Config& c) {
    return c.memory.tREFI == 0 ? 1
                               : 1 - static_cast<double>(c.memory.tRFC) / static_cast<double>(c.memory.tREFI);
}

namespace detail {
inline void finish(sim::Memory& memory, Outcome& run, std::uint64_t count, double latency) {
    memory.finish();
    run.counters = memory.counters();
    run.by_rank = memory.rank_counters();
    run.clocks = static_cast<double>(run.counters.last_clock);
    run.lines = static_cast<double>(count);
    run.latency = latency / run.lines;
}
inline cycle request(sim::Memory& memory, const Request& r, cycle t) {
    return r.write ? memory.write(r.address, t) : memory.read(r.address, t);
}
} // namespace detail

/// `in_flight` requests at all times: each answer is followed by the next request.
inline Outcome closed_loop(const Config& c, std::uint64_t in_flight, std::uint64_t count,
                           const Source& source, bool with_log = false) {
    sim::Memory memory(c, 0);
    Outcome run;
    if (with_log)
        memory.set_log(&run.log);
    std::priority_queue<cycle, std::vector<cycle>, std::greater<>> busy;
    double latency = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        cycle t = 0;
        if (busy.size() == in_flight) {
            t = busy.top();
            busy.pop();
        }
        cycle done = detail::request(memory, source(), t);
        busy.push(done);
        latency += static_cast<double>(done - t);
    }
    detail::finish(memory, run, count, latency);
    return run;
}

/// Requests at random times, `gap` clocks apart in the mean, whatever the memory does.
inline Outcome open_loop(const Config& c, double gap, std::uint64_t count, const Source& source,
                         unsigned seed = 1, bool with_log = false) {
    sim::Memory memory(c, 0);
    Outcome run;
    if (with_log)
        memory.set_log(&run.log);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> next(1 / gap);
    double now = 0, latency = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        now += next(random);
        auto t = static_cast<cycle>(now);
        latency += static_cast<double>(detail::request(memory, source(), t) - t);
    }
    detail::finish(memory, run, count, latency);
    return run;
}

} // namespace sim::test
