// The memory with queues (dram_controller.h), as a discrete-event simulation sees it: lines and core cycles
// above, bursts and memory clocks below. Requests come in order of time and may be refused; answers are told
// as soon as they are decided, which is before their time.
#pragma once

#include "sim/config/config.h"
#include "sim/core/stalls.h"
#include "sim/memory/dram_controller.h"

#include <vector>

namespace sim {

class QueuedMemory {
public:
    static constexpr cycle never = ~cycle{0};
    /// A line read, and the core cycle at which its last byte is back.
    struct Done {
        std::uint64_t id;
        cycle at;
    };

    /// Throws ConfigError where a line has more bursts than a queue.
    explicit QueuedMemory(const Config& config);
    QueuedMemory(const QueuedMemory&) = delete;
    QueuedMemory& operator=(const QueuedMemory&) = delete;

    /// A line at core cycle `t`, no earlier than any call before. False: a queue is full, and nothing was
    /// taken; there may be room after next_event().
    bool read(std::uint64_t id, std::uint64_t address, cycle t);
    bool write(std::uint64_t address, cycle t);
    /// All that is decided before core cycle `t`.
    void advance_to(cycle t);
    /// The first cycle t for which advance_to(t) decides more if nothing else comes; never: there is none.
    cycle next_event();
    /// Sends what is queued for writing without waiting for more. Requests may follow.
    void flush();
    /// flush(), and all is done: every answer is in done().
    void finish();
    /// Lines read, decided since the caller emptied it; of one call in order of time, then of requests.
    std::vector<Done>& done() { return done_; }

    /// Sums over all ranks, and each: rank r of channel c at c x ranks + r.
    MemoryCounters counters() const;
    std::vector<MemoryCounters> rank_counters() const;
    /// Every command is appended to `log`, not in time order.
    void set_log(std::vector<DramCommand>* log);

private:
    struct Line { // that is being read
        std::uint64_t id = 0, number = 0;
        Clock last = 0; // data of the bursts that have come
        std::uint32_t left = 0, next_free = 0;
    };
    struct Answer {
        std::uint64_t number;
        Done done;
    };

    Clock arrival(cycle t) const { return ((t + there_) * core_ps_ + memory_ps_ - 1) / memory_ps_; }
    cycle leave(Clock t) const { return (t * memory_ps_ + core_ps_ - 1) / core_ps_; }
    bool has_room(Column kind, std::uint64_t burst) const;
    void send(Column kind, std::uint64_t address, std::uint64_t id, cycle t);
    void advance_clock(Clock t);
    void collect(DramController& c);
    void deliver();

    std::uint64_t core_ps_, memory_ps_, there_, back_;
    unsigned burst_shift_;
    std::uint32_t parts_; // bursts of a line
    DramMapping mapping_;
    DramTiming timing_;
    std::vector<DramController> channels_;
    std::vector<Clock> next_; // their next events
    std::vector<Line> reading_;
    std::uint32_t free_ = ~std::uint32_t{0};
    std::uint64_t number_ = 0;
    std::vector<MemoryCounters> lines_; // reads and writes, by rank of the first burst
    std::vector<Answer> answers_;
    std::vector<Done> done_;
};

} // namespace sim
