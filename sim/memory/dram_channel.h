// One channel, answered request by request in the order of arrival: banks serve first come, first served, but
// a request for a row that is about to be closed still goes before the closing (row look-back, in place of a
// first-ready queue), and every command takes the first clock that DramSlots allows, gaps before later ones
// included. Writes wait in a queue; when it is filled to the high watermark, the oldest and those for the
// same rows are sent in one batch, down to the low one. Reads of a burst that is still queued are answered
// from the queue. A refresh comes at its time, neither early nor late, and closes the rows of its rank. A row
// that is closed after a timeout takes no clock of the command bus for it.
#pragma once

#include "sim/memory/counters.h"
#include "sim/memory/dram_command.h"
#include "sim/memory/dram_mapping.h"
#include "sim/memory/dram_slots.h"

#include <vector>

namespace sim {

class DramChannel {
public:
    DramChannel(std::uint32_t number, const MemoryConfig& config, const DramTiming& timing,
                std::uint64_t disorder);

    /// A burst by its number in memory; `last` of its request in this row. Returns the clock after its data.
    Clock read(const DramPlace& place, std::uint64_t burst, Clock arrival, bool last);
    /// Returns the clock at which the queue has taken the burst.
    Clock write(const DramPlace& place, std::uint64_t burst, Clock arrival);
    /// Sends all queued writes.
    void drain(Clock t);
    /// Counts refreshes before this clock (those of an earlier call once).
    void count_refreshes(Clock end);
    /// The clock after the last data so far.
    Clock quiet() const;

    /// By rank; what is of the channel alone stands with rank 0.
    std::vector<MemoryCounters> counters() const;
    /// Every command from here on is appended to `log`, not in time order; refreshes by count_refreshes().
    void set_log(std::vector<DramCommand>* log) { log_ = log; }

private:
    static constexpr std::uint64_t no_row = ~std::uint64_t{0};
    static constexpr Clock never = ~Clock{0};
    /// While one row is open.
    struct Opening {
        std::uint64_t row = no_row;
        Clock column_from = 0;
        Clock close = never; // its precharge, once decided
    };
    struct Bank {
        Opening now, before;
        Clock activated = 0;
        Clock precharge_from = 0;
        Clock used = 0;                         // the last column command
        Clock refresh = 0;                      // the first after the activation: closes what is open
        std::uint64_t batch = 0, batch_row = 0; // the last batch of writes here, and its row
    };
    struct Write {
        std::uint64_t burst;
        Clock leaves; // its data are in the devices; never: not sent yet
        DramPlace place;
    };
    enum class Row { hit, empty, conflict };
    /// A column command: from when its row is open, and when it is issued.
    struct Sent {
        Clock ready = 0, column = 0;
        Row row = Row::hit;
        bool closing = false; // its row's precharge is decided already
    };

    Bank& bank_of(const DramPlace& p) {
        return banks_[(p.rank * groups_ + p.group) * banks_per_group_ + p.bank];
    }
    Clock before_closing(const Bank& bank, const DramPlace& p, Column c, Clock now, Clock from);
    void close_if_unused(Bank& bank, const DramPlace& p, Clock now);
    Clock close_row(Bank& bank, const DramPlace& p, Clock now, Row& row);
    Sent open_row(const DramPlace& place, Column c, Clock now, Clock from);
    void send(const DramPlace& place, Column c, const Sent& s, bool last);
    void send_batch(Clock now);
    void log(DramCommand::Kind kind, Clock at, const DramPlace& p, bool automatic = false);

    const DramTiming& t_;
    DramSlots slots_;
    std::uint32_t number_, groups_, banks_per_group_;
    bool closed_page_;
    Clock page_timeout_; // never: no limit
    std::size_t capacity_, high_, low_;
    std::vector<Bank> banks_;
    std::vector<Write> queue_; // in order of arrival
    std::uint64_t batch_ = 0;
    std::size_t waiting_ = 0;              // of these, not sent
    std::vector<MemoryCounters> counters_; // by rank
    Clock refreshed_ = 0;                  // refreshes before this are counted
    std::vector<DramCommand>* log_ = nullptr;
};

} // namespace sim
