// The memory with queues (dram_controller.h), as a discrete-event simulation sees it. Requests come in order
// of time and may be refused; answers are told as soon as they are decided, which is before their time.
#pragma once

#include "sim/memory/dram_controller.h"
#include "sim/memory/memory_lines.h"

#include <string>
#include <vector>

namespace sim {

class QueuedMemory final : public MemoryLines {
public:
    static constexpr cycle never = ~cycle{0};
    /// A line read, and the core cycle at which its last byte is back.
    struct Done {
        std::uint64_t id;
        cycle at;
    };

    /// What of the machine's queues is too small for its lines, in which they would wait for ever; or
    /// nothing.
    static std::string mistake(const Config& config);
    /// Throws ConfigError of that mistake.
    explicit QueuedMemory(const Config& config);

    /// A line at core cycle `t`, no earlier than any call before. False: a queue is full, and nothing was
    /// taken; there may be room after next_event().
    bool read(std::uint64_t id, std::uint64_t address, cycle t);
    bool write(std::uint64_t address, cycle t);
    /// When the controller has a line that was written at core cycle `t`.
    cycle taken(cycle t) const { return leave(arrival(t)); }
    /// A line that was refused at core cycle `since` and taken at `until` has waited.
    void count_wait(Column kind, std::uint64_t address, cycle since, cycle until);
    /// The first of the channels that a line goes to. Lines that share one share all.
    std::uint32_t channel_of(std::uint64_t address) const { return place(first_burst(address)).channel; }
    /// All that is decided before core cycle `t`.
    void advance_to(cycle t);
    /// The first cycle t for which advance_to(t) decides more if nothing else comes; never: there is none.
    cycle next_event();
    /// Sends what is queued for writing without waiting for more. Requests may follow.
    void flush();
    /// flush(), and all is done: every answer is in done(). Returns the core cycle after the last data.
    cycle finish();
    /// Lines that are being read and not decided.
    std::size_t reading() const { return undecided_; }
    /// Lines read, decided since the caller emptied it; of one call in order of time, then of requests.
    std::vector<Done>& done() { return done_; }

    /// Sums over all ranks, and each: rank r of channel c at c x ranks + r.
    MemoryCounters counters() const { return sum_of(rank_counters()); }
    std::vector<MemoryCounters> rank_counters() const { return rank_counters_of(channels_); }
    /// Every command is appended to `log`, not in time order.
    void set_log(std::vector<DramCommand>* log);

private:
    struct Line { // that is being read
        std::uint64_t id = 0, number = 0;
        cycle least = 0; // no answer is earlier
        Clock last = 0;  // data of the bursts that have come
        std::uint32_t left = 0, next_free = 0;
    };
    struct Answer {
        std::uint64_t number;
        Done done;
    };

    bool has_room(Column kind, std::uint64_t burst);
    void send(Column kind, std::uint64_t burst, std::uint64_t id, Clock t);
    void set_next(std::size_t channel, Clock t);
    void advance_clock(Clock t);
    void collect(DramController& c);
    void deliver();

    std::vector<DramController> channels_;
    std::vector<Clock> next_;       // their next events
    Clock soonest_;                 // of these
    std::vector<DramPlace> places_; // of the bursts of the line that is asked about
    cycle shortest_;
    std::vector<Line> reading_;
    std::uint32_t free_ = ~std::uint32_t{0};
    std::uint64_t number_ = 0;
    std::size_t undecided_ = 0;
    std::vector<Answer> answers_;
    std::vector<Done> done_;
};

} // namespace sim
