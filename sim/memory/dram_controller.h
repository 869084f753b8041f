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

#include <algorithm>
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
    /// Writes that are queued no longer wait for company.
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
    /// What a bank would do next for a queue, as far as the bank alone says.
    struct Wish {
        Clock from, until;     // until: the last clock that leaves time before a refresh
        std::uint64_t urgency; // the less the sooner: columns before rows, then in order of arrival
        Index shared;          // where shared_ says from when the others allow it
        Index bank;
    };
    struct Queue {
        std::size_t size = 0, capacity = 0;
        Index oldest = none, youngest = none;
        std::vector<Wish> banks; // that have bursts queued, in no order that matters
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
        Clock used = 0;                 // the last column command
        Clock refreshed = 0;            // the last refresh
        Clock closed_from = 0;          // of the last closing for a refresh
        std::uint64_t refreshes = 0;
        std::array<Clock, 4> activates{};
        std::uint64_t activated = 0;
        std::size_t queued = 0, open = 0;
        bool postponed = false;
    };
    struct Step {
        enum Kind : std::uint8_t {
            column,
            activate,
            precharge,
            close_idle,
            decide,
            refresh,
            close_for_refresh
        };
        Clock at = never;
        std::uint64_t urgency = never;
        Kind kind = decide;
        Index of = none; // bank, or rank of what comes with refreshes
        bool before(const Step& s) const { return at != s.at ? at < s.at : urgency < s.urgency; }
    };
    /// In shared_: from when a read, a write, an activate, a precharge (any time) of a group may come.
    enum Shared : Index { shared_read, shared_write, shared_activate, shared_precharge, shared_kinds };
    static constexpr unsigned row_command_bit = 62;
    static constexpr std::uint64_t row_command = std::uint64_t{1} << row_command_bit,
                                   idle_row = row_command << 1;

    /// The first clock at which a rank without requests may make up for a refresh, once that is decided at
    /// `t`.
    Clock made_up(const Rank& r, Clock t) const {
        return std::max({t + t_.around_refresh(), r.due, r.refreshed + t_.tRFC});
    }
    /// Whether a rank has requests, or had some not long before `t`: then its refreshes may wait.
    bool busy(const Rank& r, Clock t) const { return r.queued != 0 || r.used + t_.around_refresh() > t; }
    Column direction() const { return writing_ ? Column::write : Column::read; }
    Index set(const Bank& b) const { return b.rank * groups_ + b.group; }
    static Shared shared_column(Column c) { return c == Column::read ? shared_read : shared_write; }
    Clock* shared_from(Shared kind) { return shared_.data() + kind * ranks_ * groups_; }
    void plan() {
        if (!planned_)
            make_plan();
    }
    void make_plan();
    void plan_urgent(const Queue& q, Clock from);
    void plan_unasked(Clock from);
    void plan_refreshes(Clock from);
    void plan_idle_banks(Clock from);
    Wish wish(const Bank& b, Index number, std::size_t kind, bool only_oldest) const;
    Index number_of(const Bank& b) const { return static_cast<Index>(&b - banks_.data()); }
    /// After a change of what the bank has queued or of its state.
    void renew(Index number) {
        for (std::size_t k = 0; k < 2; ++k)
            if (banks_[number].oldest[k] != none)
                queue_[k].banks[banks_[number].place[k]] = wish(banks_[number], number, k, !first_ready_);
    }
    /// From when all but the bank allow what it wishes; `from`: by bus, of columns and of rows.
    Clock allowed(const Wish& w, const std::array<Clock, 2>& from) const {
        return std::max(from[w.urgency >> row_command_bit], shared_[w.shared]);
    }
    std::array<Clock, 2> with_buses(Clock from) const {
        return {std::max(from, bus_from_[column_bus_]), std::max(from, bus_from_[0])};
    }
    /// The clock at which the oldest burst has waited too long.
    Clock patience(const Queue& q) const {
        return age_cap_ == 0 || q.size == 0 ? never : entries_[q.oldest].arrival + age_cap_;
    }
    void consider(const Wish& w, Clock from, const Step* urgent);
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
    std::vector<Clock> shared_;       // by Shared, rank, group
    std::array<Clock, 2> bus_from_{}; // of rows, of columns
    Clock refreshes_from_ = never;    // nothing that has to do with refreshes comes earlier
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
