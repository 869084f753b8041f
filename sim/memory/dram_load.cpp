#include "sim/memory/dram_load.h"

#include "sim/memory/memory.h"
#include "sim/memory/queued_memory.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <queue>
#include <random>

namespace sim {
namespace {

/// When requests are wanted.
class Arrivals {
public:
    explicit Arrivals(const DramLoad& load) : gap_(load.gap), random_(load.seed) {}
    cycle next() {
        // Not exponential_distribution: its digits are the library's.
        if (gap_ > 0)
            now_ -= gap_ * std::log1p(-static_cast<double>(random_() >> 11) * 0x1p-53);
        return static_cast<cycle>(now_);
    }

private:
    double gap_, now_ = 0;
    std::mt19937_64 random_;
};

template <class M>
DramOutcome summary(const Config& config, const M& memory, std::uint64_t requests,
                    std::vector<std::uint64_t>& latencies) {
    DramOutcome o;
    o.counters = memory.counters();
    o.by_rank = memory.rank_counters();
    o.requests = requests;
    o.reads = latencies.size();
    o.clocks = static_cast<double>(o.counters.last_clock);
    o.bytes_per_clock =
        static_cast<double>(requests * static_cast<std::uint64_t>(config.last_cache().line_bytes)) / o.clocks;
    if (latencies.empty())
        return o;
    std::sort(latencies.begin(), latencies.end());
    double sum = 0;
    for (std::uint64_t l : latencies)
        sum += static_cast<double>(l);
    o.mean = sum / static_cast<double>(latencies.size());
    auto at = [&](double part) { // nearest rank
        auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(latencies.size())));
        return static_cast<double>(latencies[std::max<std::size_t>(rank, 1) - 1]);
    };
    o.median = at(0.5), o.p95 = at(0.95), o.p99 = at(0.99), o.longest = at(1);
    return o;
}

} // namespace

Config in_memory_clocks(Config c) {
    c.chip.clock_ps = c.memory.clock_ps;
    c.memory.controller_cycles = 0;
    return c;
}

DramOutcome run_dram_immediate(const Config& config, const DramStream& stream, const DramLoad& load,
                               bool with_log) {
    Config c = in_memory_clocks(config);
    Memory memory(c, 0);
    std::vector<DramCommand> log;
    if (with_log)
        memory.set_log(&log);
    Arrivals arrivals(load);
    std::priority_queue<cycle, std::vector<cycle>, std::greater<>> open;
    std::vector<std::uint64_t> latencies;
    latencies.reserve(load.requests);
    cycle now = 0;
    for (std::uint64_t i = 0; i < load.requests; ++i) {
        now = std::max(now, arrivals.next());
        while (!open.empty() && (open.top() <= now || open.size() >= load.in_flight)) {
            now = std::max(now, open.top());
            open.pop();
        }
        DramRequest r = stream();
        if (r.write) {
            now = std::max(now, memory.write(r.address, now));
            continue;
        }
        cycle end = memory.read(r.address, now);
        latencies.push_back(end - now);
        open.push(end);
    }
    memory.finish();
    DramOutcome o = summary(c, memory, load.requests, latencies);
    o.log = std::move(log);
    return o;
}

DramOutcome run_dram_queued(const Config& config, const DramStream& stream, const DramLoad& load,
                            bool with_log) {
    Config c = in_memory_clocks(config);
    QueuedMemory memory(c);
    std::vector<DramCommand> log;
    if (with_log)
        memory.set_log(&log);
    Arrivals arrivals(load);
    std::priority_queue<cycle, std::vector<cycle>, std::greater<>> open; // answers that are decided
    std::vector<cycle> sent_at(load.requests);
    std::vector<std::uint64_t> latencies;
    latencies.reserve(load.requests);
    std::uint64_t undecided = 0;
    cycle now = 0;
    auto collect = [&] {
        for (const QueuedMemory::Done& d : memory.done()) {
            latencies.push_back(d.at - sent_at[d.id]);
            open.push(d.at);
            --undecided;
        }
        memory.done().clear();
    };
    auto take_answers = [&] {
        while (!open.empty() && open.top() <= now)
            open.pop();
    };
    // To the clock at which the memory decides more, or an answer comes, whichever is first.
    auto go_on = [&] {
        take_answers();
        cycle next = memory.next_event();
        now = std::max(now, open.empty() ? next : std::min(next, open.top()));
        memory.advance_to(now);
        collect();
    };
    for (std::uint64_t i = 0; i < load.requests; ++i) {
        cycle wanted = std::max(now, arrivals.next());
        for (;;) {
            take_answers();
            bool full = open.size() + undecided >= load.in_flight;
            if (!full && now >= wanted)
                break;
            if (full) {
                go_on();
            } else {
                now = wanted;
                memory.advance_to(now);
                collect();
            }
        }
        sent_at[i] = now;
        DramRequest r = stream();
        undecided += r.write ? 0 : 1;
        while (!(r.write ? memory.write(r.address, now) : memory.read(i, r.address, now)))
            go_on();
        collect();
    }
    memory.finish();
    collect();
    DramOutcome o = summary(c, memory, load.requests, latencies);
    o.log = std::move(log);
    return o;
}

} // namespace sim
