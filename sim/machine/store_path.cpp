// Stores on their way through a store buffer, and loads that meet them there (core.store_buffer). A store
// that finds the buffer full has issued, but holds up younger operations until its last entry is free.
#include "sim/machine/issue.h"

#include <bit>

namespace sim {

/// Ends the oldest entry; returns when that was.
cycle Engine::drain_oldest(Hart& h) {
    StoreBuffer::Entry& e = h.store_buffer.entry(0);
    return h.store_buffer.pop(is_ticket(e.until) ? await(h, e.until).last : e.until);
}

/// The bytes [low, high] of one machine store: an entry for each line, from `from` on, and its access of the
/// L1, for which a port takes so many slots (0: as many as the bytes there need).
void Engine::buffer_store(Hart& h, std::uint64_t low, std::uint64_t high, bool whole, cycle& from, Data& all,
                          std::uint32_t slots) {
    StoreBuffer& b = h.store_buffer;
    for (std::uint64_t line = low >> line_shift_; line <= high >> line_shift_; ++line) {
        cycle free = b.full() ? drain_oldest(h) : 0;
        if (free > from) {
            from = free;
            all.granted = std::max(all.granted, free);
            all.held = Cause::stores;
        }
        from = std::max(from, h.bound.at()); // it may have waited for the answer
        Data data;
        cycle start = std::max(from, b.asked);
        const std::uint64_t place = std::max(low, line << line_shift_);
        touch_line(h, place, bytes_in(place, high), true, 1, slots != 0 ? slots : slots_in(line, low, high),
                   start, data);
        b.asked = start;
        std::uint64_t first = std::max(low, line << line_shift_);
        std::uint64_t last = std::min(high, ((line + 1) << line_shift_) - 1);
        b.push({first, last, whole, data.open != 0 ? data.tickets[0] : data.last, data.from});
        ++h.counters.buffered_stores;
        stored(h, data);
    }
}

void Engine::buffer_bytes(Hart& h, std::uint64_t address, std::uint32_t bytes, cycle from, Data& data) {
    buffer_store(h, address, address + bytes - 1, true, from, data);
}

namespace {

/// Visits the lanes of each sub-vector that has any: (number, lanes that are on, from its first).
template <class Visit>
void each_piece(std::uint32_t pieces, std::uint32_t piece_lanes, std::uint64_t lanes, Visit visit) {
    std::uint64_t mask = ~std::uint64_t{0} >> (64 - piece_lanes);
    for (std::uint32_t i = 0; i < pieces; ++i)
        if (std::uint64_t on = lanes >> (i * piece_lanes) & mask; on != 0)
            visit(i, on);
}

/// The bytes of consecutive lanes, relative to lane 0.
struct Bytes {
    std::uint64_t low, high;
    bool whole;
};
Bytes bytes_of(std::uint64_t on) {
    auto first = static_cast<unsigned>(std::countr_zero(on));
    auto last = 63 - static_cast<unsigned>(std::countl_zero(on));
    return {4 * std::uint64_t{first}, 4 * std::uint64_t{last} + 3,
            static_cast<unsigned>(std::popcount(on)) == last - first + 1};
}

} // namespace

void Engine::buffer_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data) {
    std::uint32_t bytes = piece_lanes_ * 4;
    each_piece(pieces_, piece_lanes_, lanes, [&](std::uint32_t i, std::uint64_t on) {
        Bytes b = bytes_of(on);
        std::uint64_t piece = address + i * bytes;
        buffer_store(h, piece + b.low, piece + b.high, b.whole, from, data);
    });
}

/// A scatter: an entry for every distinct line of a sub-vector, or (core.gather = "lane") every lane.
void Engine::buffer_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                            cycle from, Data& data) {
    auto at = [&](std::uint32_t lane) {
        return address + static_cast<std::uint64_t>(std::int64_t{index[lane]} * 4);
    };
    each_piece(pieces_, piece_lanes_, lanes, [&](std::uint32_t i, std::uint64_t on) {
        while (on != 0) {
            std::uint32_t begin = i * piece_lanes_;
            std::uint64_t low = at(begin + static_cast<unsigned>(std::countr_zero(on)));
            std::uint64_t high = low + 3;
            std::uint64_t line = low >> line_shift_;
            bool one = true;
            on &= on - 1;
            for (std::uint64_t rest = lane_scatter_ ? 0 : on; rest != 0; rest &= rest - 1) {
                auto lane = static_cast<unsigned>(std::countr_zero(rest));
                std::uint64_t a = at(begin + lane);
                if (a >> line_shift_ != line)
                    continue;
                low = std::min(low, a);
                high = std::max(high, a + 3);
                one = false;
                on &= ~(std::uint64_t{1} << lane);
            }
            buffer_store(h, low, high, one, from, data, 1);
        }
    });
}

// --- loads

/// The youngest entry with any of the bytes [low, high] that is not known to have ended at `t`, or how many
/// there are.
std::size_t Engine::buffered_at(Hart& h, std::uint64_t low, std::uint64_t high, cycle t) {
    StoreBuffer& b = h.store_buffer;
    std::size_t youngest = b.size();
    while (youngest != 0 && !(b.entry(youngest - 1).low <= high && low <= b.entry(youngest - 1).high))
        --youngest;
    if (youngest == 0)
        return b.size();
    cycle ended = b.ended();
    for (std::size_t i = 0; i < youngest; ++i) {
        StoreBuffer::Entry& e = b.entry(i);
        if (Answered a; is_ticket(e.until) && h.tile->tickets.find(e.until, a))
            e.until = a.last;
        ended = std::max(ended, e.until); // a ticket is later than all cycles
        if (ended > t)
            return youngest - 1;
    }
    return b.size();
}

/// When an entry and all before it have ended.
cycle Engine::drained(Hart& h, std::size_t entry) {
    cycle ended = h.store_buffer.ended();
    for (std::size_t i = 0; i <= entry; ++i) {
        StoreBuffer::Entry& e = h.store_buffer.entry(i);
        if (is_ticket(e.until))
            e.until = await(h, e.until).last;
        ended = std::max(ended, e.until);
    }
    return ended;
}

/// One machine load of the bytes [low, high]: forwarded from the youngest store that has any of them if that
/// wrote all of them, else from the L1 when it has ended.
void Engine::load_around(Hart& h, std::uint64_t low, std::uint64_t high, cycle from, Data& data) {
    from = std::max(from, h.bound.at()); // as the piece before may have waited
    std::size_t entry = buffered_at(h, low, high, from);
    if (entry != h.store_buffer.size()) {
        StoreBuffer::Entry& e = h.store_buffer.entry(entry);
        if (e.whole && e.low <= low && high <= e.high) { // it has asked the L1 as well
            ++h.counters.forwarded_loads;
            std::uint32_t slots = slots_in(low >> line_shift_, low, high);
            h.core->l1.counters().busy_cycles += slots;
            cycle at = (h.core->ports.take(from << port_shift_, slots).last >> port_shift_) + l1_latency_;
            data.first = std::min(data.first, at);
            if (at > data.last) {
                data.last = at;
                data.from = Cause::l1;
            }
            return;
        }
        ++h.counters.blocked_loads;
        cycle ended = drained(h, entry);
        from = std::max({from, ended, h.bound.at()});
    }
    for (std::uint64_t line = low >> line_shift_; line <= high >> line_shift_; ++line) {
        const std::uint64_t place = std::max(low, line << line_shift_);
        touch_line(h, place, bytes_in(place, high), false, 1, slots_in(line, low, high), from, data);
    }
}

/// Whether a store that may not have ended at `from` wrote any of the bytes.
bool Engine::meets_stores(Hart& h, std::uint64_t low, std::uint64_t high, cycle from) {
    return buffered_at(h, low, high, from) != h.store_buffer.size();
}

void Engine::load_bytes_around(Hart& h, std::uint64_t address, std::uint32_t bytes, cycle from, Data& data) {
    load_around(h, address, address + bytes - 1, from, data);
}

void Engine::load_lanes_around(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data) {
    std::uint32_t bytes = piece_lanes_ * 4;
    each_piece(pieces_, piece_lanes_, lanes, [&](std::uint32_t i, std::uint64_t on) {
        Bytes b = bytes_of(on);
        std::uint64_t piece = address + i * bytes;
        load_around(h, piece + b.low, piece + b.high, from, data);
    });
}

/// Gathers are not forwarded: from when one may go to the L1.
cycle Engine::gather_after(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                           cycle from) {
    std::size_t youngest = 0;
    bool any = false;
    for (std::uint64_t rest = h.store_buffer.empty() ? 0 : lanes; rest != 0; rest &= rest - 1) {
        std::uint64_t a =
            address + static_cast<std::uint64_t>(std::int64_t{index[std::countr_zero(rest)]} * 4);
        std::size_t entry = buffered_at(h, a, a + 3, from);
        if (entry != h.store_buffer.size()) {
            youngest = std::max(youngest, entry);
            any = true;
        }
    }
    if (!any)
        return from;
    ++h.counters.blocked_loads;
    cycle ended = drained(h, youngest);
    return std::max({from, ended, h.bound.at()});
}

} // namespace sim
