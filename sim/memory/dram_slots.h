// The clocks of one channel at which each kind of command may be issued: bitmaps, one bit a clock, in a ring.
// A command that is booked marks, for every kind of command, the clocks at which that kind would come too
// near before or after it. So a command may go into any gap between others booked for later, and still keeps
// every distance: of data on the bus, of bank groups and ranks, of turnarounds, of activates (tRRD, tFAW) and
// of refreshes, with which every word of the ring begins.
#pragma once

#include "sim/core/calendar.h"
#include "sim/memory/dram_timing.h"

#include <bit>
#include <vector>

namespace sim {

class DramSlots {
public:
    /// `disorder`: how much earlier than its predecessors a request may come. The ring grows to whatever is
    /// booked at one time.
    DramSlots(const MemoryConfig& config, const DramTiming& timing, std::uint64_t disorder);

    /// Requests come at `now`, and no more than the disorder earlier, from here on.
    void set_now(Clock now) { kept_ = std::max(kept_, (now > lookback_ ? now - lookback_ : 0) / 64); }

    /// The first clock from `from` on at which a command may be issued. `now`: when its request came. Where
    /// much is booked after that, commands keep step with each other, or the gaps between them would go to
    /// waste: activates take every tFAW / 4th clock, and precharges leave those to them; a column command
    /// takes a gap that it fills without a rest, if one is near.
    Clock find_precharge(Clock from, Clock now, std::uint32_t rank) {
        return find(from, row_bus_, rows_pressed(now, rank) ? beats_ + rank : row_bus_);
    }
    Clock find_activate(Clock from, Clock now, std::uint32_t rank, std::uint32_t group) {
        std::uint32_t kind = no_activate_ + rank * groups_ + group;
        return rows_pressed(now, rank) ? find_on_beat(from, beats_ + rank, kind) : find(from, row_bus_, kind);
    }
    Clock find_column(Clock from, Clock now, Column c, std::uint32_t rank, std::uint32_t group) {
        return bus_pressed(now) ? find_gap(from, c, rank, group)
                                : find(from, column_bus_, column_kind(c, rank, group));
    }
    /// The first clock from which writes may follow each other for `length` clocks.
    Clock find_room_to_write(Clock from, std::uint64_t length);

    void take_precharge(Clock t) { take_bus(t, row_bus_); }
    void take_activate(Clock t, std::uint32_t rank, std::uint32_t group);
    void take_column(Clock t, Column c, std::uint32_t rank, std::uint32_t group);

    /// Changes between neighbouring bursts in time order, of all booked so far.
    std::uint64_t turnarounds() const { return static_cast<std::uint64_t>(turnarounds_); }
    std::uint64_t rank_switches() const { return static_cast<std::uint64_t>(rank_switches_); }

    /// The start of the rank's first refresh after `t`; the largest clock where there are none.
    Clock next_refresh(Clock t, std::uint32_t rank);
    Clock first_refresh(std::uint32_t rank) const;

private:
    using Bits = std::uint64_t;
    struct Burst {
        bool known = false;
        bool write = false;
        std::uint32_t rank = 0;
        Clock at = 0;
    };
    static constexpr Bits all = ~Bits{0};

    std::uint32_t column_kind(Column c, std::uint32_t rank, std::uint32_t group) const {
        return no_column_ + (rank * groups_ + group) * 2 + static_cast<std::uint32_t>(c);
    }
    /// How many bits are set in the 64 clocks from `t` on.
    int booked_from(Clock t, std::uint32_t bitmap) {
        Bits bits = word(t / 64)[bitmap] >> (t % 64);
        if (t % 64 != 0)
            bits |= word(t / 64 + 1)[bitmap] << (64 - t % 64);
        return std::popcount(bits);
    }
    bool rows_pressed(Clock t, std::uint32_t rank) {
        return booked_from(t, activates_ + rank) >= pressing_activates_;
    }
    bool bus_pressed(Clock t) { return booked_from(t, columns_) >= pressing_columns_; }

    Bits* word(std::uint64_t number) {
        Bits* w = &words_[(number & mask_) * size_];
        if (w[0] != number) [[unlikely]] {
            if (number < kept_)
                calendar_has_passed("memory commands", number * 64, kept_ * 64);
            if (number - kept_ > mask_)
                return grown(number);
            renew(w, number);
        }
        return w;
    }
    Bits* grown(std::uint64_t number);
    void renew(Bits* w, std::uint64_t number);
    Clock find(Clock from, std::uint32_t bus, std::uint32_t kind) {
        std::uint64_t number = from / 64;
        for (Bits open = all << (from % 64);; ++number, open = all) {
            const Bits* w = word(number);
            Bits free = ~(w[bus] | w[kind]) & open;
            if (free != 0)
                return number * 64 + static_cast<unsigned>(std::countr_zero(free));
        }
    }
    Clock find_on_beat(Clock from, std::uint32_t beats, std::uint32_t kind) {
        std::uint64_t number = from / 64;
        for (Bits open = all << (from % 64);; ++number, open = all) {
            const Bits* w = word(number);
            Bits free = ~(w[row_bus_] | w[kind]) & w[beats] & open;
            if (free != 0)
                return number * 64 + static_cast<unsigned>(std::countr_zero(free));
        }
    }
    Clock find_gap(Clock from, Column c, std::uint32_t rank, std::uint32_t group);
    Clock rest(const Burst& first, const Burst& second) const;
    void take_bus(Clock t, std::uint32_t bus);
    void forbid_activates(Clock first, Clock last, std::uint32_t rank);
    void forbid_near_activates(Clock t, std::uint32_t rank);
    void count_changes(Clock t, const Burst& burst);
    Burst before(Clock t);
    Burst after(Clock t);
    Burst burst_at(const Bits* w, std::uint64_t number, unsigned bit) const;

    const DramTiming& t_;
    std::uint32_t ranks_, groups_, rank_planes_;
    // Where the bitmaps stand in a word: its number first.
    std::uint32_t row_bus_, column_bus_, columns_, writes_, planes_, activates_, beats_, no_activate_,
        no_column_, size_;
    std::uint64_t mask_, kept_ = 0; // the first word that is still needed
    Clock lookback_;                // the disorder, and how far before it a command still looks and marks
    std::vector<Bits> words_;
    struct Interval {
        Clock begin = 0, end = 0;
    };
    std::vector<Interval> between_refreshes_; // by rank: where the last question was
    Clock latest_ = 0;                        // the last column command in time
    Burst latest_burst_;
    std::int64_t turnarounds_ = 0, rank_switches_ = 0;
    Clock reach_ = 1; // of a column command's marks
    Clock beat_;      // from activate to activate of a pressed rank, in quarters of a clock
    int pressing_activates_, pressing_columns_;
};

} // namespace sim
