// One channel with queues, in time order: reads and writes wait in queues of their own, and at every clock
// the controller may issue, it chooses among what the devices would take then: column commands before row
// commands, the oldest burst first (FR-FCFS: Rixner et al., "Memory access scheduling", 2000), each bank
// serving its open row before others. A burst older than the age cap goes first, and nothing that would delay
// it is issued. Writes wait until the high watermark is reached or no read is queued; then they are sent down
// to the low one, reads going on as soon as they come unless the high one was reached. Reads of a burst that
// is still queued for writing are answered at once.
//
// Refreshes of a rank, or of one bank after the other, come at their time to the clock, and what could not be
// closed before is not opened; a rank with requests may put its refreshes off and makes up for them when it
// has none. Not modelled: refreshes ahead of time, rows opened for writes while reads are sent (and the other
// way round), commands of two clocks.
#pragma once

#include "sim/memory/counters.h"
#include "sim/memory/dram_command.h"
#include "sim/memory/dram_mapping.h"
#include "sim/memory/dram_timing.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sim {

class DramController {
public:
    static constexpr Clock never = ~Clock{0};
    /// A read, and the clock after its last data.
    struct Done {
        std::uint64_t id;
        Clock at;
    };

    DramController(std::uint32_t number, const MemoryConfig& config, const DramTiming& timing);

    /// Whether the queue takes `bursts` more.
    bool has_room(Column kind, std::size_t bursts) const {
        return queue_[at(kind)].size + bursts <= queue_[at(kind)].capacity;
    }
    /// A burst by its number in memory that arrives at clock `t`, no earlier than anything before; false: its
    /// queue is full. Reads come back in done() under `id`.
    bool enqueue(Column kind, const DramPlace& place, std::uint64_t burst, std::uint64_t id, Clock t);
    /// Issues every command of the clocks before `t`.
    void advance_to(Clock t) {
        for (plan(); step_.at < t; plan())
            issue();
        now_ = now_ > t ? now_ : t;
    }
    /// The clock of the next command if nothing more comes; never where there is none.
    Clock next_event() {
        plan();
        return step_.at;
    }
    /// Writes no longer wait for company.
    void flush();
    bool empty() const { return queue_[0].size + queue_[1].size == 0; }

    /// Reads whose data are on their way, in the order of their column commands; the caller empties it.
    std::vector<Done>& done() { return done_; }
    /// By rank; what is of the channel alone stands with rank 0.
    const std::vector<MemoryCounters>& counters() const { return counters_; }
    /// Every command from here on is appended to `log`; only precharges that come with a column command are
    /// not in time order.
    void set_log(std::vector<DramCommand>* log) { log_ = log; }

private:
    using Index = std::uint32_t;
    static constexpr Index none = ~Index{0};
    enum class Row : std::uint8_t { hit, empty, conflict };

    struct Entry {
        std::uint64_t burst, id, row, number; // number: in order of arrival
        Clock arrival;
        Index bank, bank_next, bank_before, next, before; // neighbours of its bank and in its queue
        Row found;
    };
    struct Queue {
        std::size_t size = 0, capacity = 0;
        Index oldest = none, youngest = none;
        std::vector<Index> banks; // that have bursts queued, in no order that matters
    };
    struct Bank {
        std::uint64_t row = 0;
        Clock activate_from = 0, column_from = 0, precharge_from = 0, used = 0;
        Clock refresh = never; // its next
        std::array<Index, 2> oldest{none, none}, youngest{none, none};
        std::array<Index, 2> hit{none, none};   // the oldest burst of the open row
        std::array<Index, 2> place{none, none}; // in the queue's banks
        Index rank = 0, group = 0, bank = 0;
        bool open = false, conflict = false; // conflict: closed for another row
    };
    struct Rank {
        Clock refresh = never, due = 0; // the next, and when it should be
        Clock closed_from = 0;          // of the last closing for a refresh
        std::uint64_t refreshes = 0;
        std::array<Clock, 4> activates{};
        std::uint64_t activated = 0;
        std::size_t queued = 0, open = 0;
        bool postponed = false;
    };
    struct Step {
        enum Kind : std::uint8_t {
            decide,
            refresh,
            close_for_refresh,
            column,
            activate,
            precharge,
            close_idle
        };
        Clock at = never;
        Kind kind = decide;
        Index of = none;          // bank, or rank of what comes with refreshes
        std::uint64_t number = 0; // of the burst it is for
        unsigned order() const { return kind <= close_for_refresh ? 0U : kind == column ? 1U : 2U; }
        bool before(const Step& s) const {
            if (at != s.at)
                return at < s.at;
            if (order() != s.order())
                return order() < s.order();
            return number != s.number ? number < s.number : of < s.of;
        }
    };

    Column direction() const { return writing_ ? Column::write : Column::read; }
    std::size_t set(const Bank& b) const { return b.rank * groups_ + b.group; }
    void plan() {
        if (!planned_)
            make_plan();
    }
    void make_plan();
    void plan_refreshes(Clock from);
    void plan_idle_banks(Clock from);
    Step candidate(const Bank& b, Index number, Clock from, bool only_oldest) const;
    bool delays(const Step& s, const Step& urgent) const;
    void issue();
    void issue_column(Bank& b);
    void issue_activate(Bank& b);
    void close(Bank& b, Clock at);
    void refresh(Index rank);
    void schedule_refresh(Rank& r, Index rank);
    void set_refresh(Rank& r, Index rank, Clock at);
    Clock due(Index rank, std::uint64_t number) const;
    void find_hits(Bank& b);
    void remove(Index entry, std::size_t kind);
    void choose_direction();
    void log(DramCommand::Kind kind, Clock at, const Bank& b, std::uint64_t row, bool automatic = false);

    const DramTiming& t_;
    std::uint32_t number_, ranks_, groups_, banks_per_rank_, column_bus_;
    bool first_ready_, closed_page_, timeout_page_, per_bank_;
    std::size_t high_, low_;
    Clock age_cap_, page_timeout_, postponable_;
    std::array<Queue, 2> queue_; // by Column
    std::vector<Entry> entries_;
    Index free_ = none; // entries, by their `next`
    std::vector<Bank> banks_;
    std::vector<Rank> ranks_state_;
    std::vector<Clock> activate_from_;              // by rank and group
    std::array<std::vector<Clock>, 2> column_from_; // by Column, rank and group
    std::array<Clock, 2> bus_from_{};               // of rows, of columns
    bool writing_ = false, draining_ = false, flushing_ = false, planned_ = false;
    Clock now_ = 0;
    Step step_;
    std::uint64_t arrivals_ = 0;
    bool any_ = false, last_write_ = false; // the last burst on the bus
    Index last_rank_ = 0;
    std::vector<Done> done_;
    std::vector<MemoryCounters> counters_;
    std::vector<DramCommand>* log_ = nullptr;
};

} // namespace sim
