#include "sim/memory/l2.h"

#include <algorithm>
#include <bit>

namespace sim {
namespace {

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}

} // namespace

L2::L2(const Config& config, std::uint32_t tile, const cycle& earliest, Tickets& tickets,
       Attribution& attribution)
    : tile_(tile), line_shift_(static_cast<unsigned>(std::countr_zero(wide(config.l2.line_bytes)))),
      latency_(wide(config.l2.latency)), bank_mask_(wide(config.l2.banks) - 1),
      occupancy_(static_cast<std::uint32_t>((config.l1.line_bytes + config.l2.bank_bytes - 1) /
                                            config.l2.bank_bytes)),
      whole_lines_(config.l1.line_bytes == config.l2.line_bytes),
      array_(wide(config.l2.size_bytes / (config.l2.ways * config.l2.line_bytes)), wide(config.l2.ways)),
      banks_(wide(config.l2.banks), Calendar("L2 bank", earliest)),
      flight_limit_(wide(config.l2.mshrs) * 4 + 64), tickets_(tickets), attribution_(attribution) {}

void L2::note_write_back(std::uint64_t address, std::size_t column) {
    Traffic& owner = attribution_.cell(address, column);
    ++counters_.write_backs;
    ++owner.l2_write_backs;
    ++owner.memory_writes;
}

/// When a line that is on its way comes: a cycle or an open ticket; 0 if it has long been there.
cycle L2::arrival(std::uint64_t line) {
    for (std::size_t i = flights_.size(); i-- > 0;)
        if (flights_[i].line == line) {
            Flight& f = flights_[i];
            Answered a;
            if (is_ticket(f.until) && tickets_.find(f.until, a))
                f.until = a.last;
            return f.until;
        }
    return 0;
}

Answer L2::in_flight(CacheArray::Entry entry, std::uint64_t line, cycle done) {
    cycle until = arrival(line);
    if (until > done) { // also a ticket
        ++counters_.hits_in_flight;
        if (is_ticket(until)) // the line may be there before the bank has got round to it
            until = tickets_.no_earlier(until, done, Cause::l2);
        return {until, Cause::memory};
    }
    array_.set_in_flight(entry, false);
    return {done, Cause::l2};
}

Answer L2::access(std::uint64_t address, cycle t, std::size_t column, bool write, bool needs_data) {
    std::uint64_t line = address >> line_shift_;
    Traffic& cell = attribution_.cell(address, column);
    ++(write ? counters_.writes : counters_.reads);
    ++(write ? cell.l2_writes : cell.l2_reads);
    counters_.busy_cycles += occupancy_;
    cycle start = banks_[line & bank_mask_].take_run(t, occupancy_);
    quiet_ = std::max(quiet_, start + occupancy_);
    cycle done = start + latency_;
    CacheArray::Entry entry = array_.find(line);
    if (entry != CacheArray::none) {
        ++counters_.hits;
        array_.touch(entry);
        if (write)
            array_.set_dirty(entry, true);
        if (array_.in_flight(entry)) [[unlikely]]
            return in_flight(entry, line, done);
        return {done, Cause::l2};
    }
    ++counters_.misses;
    ++cell.l2_misses;
    entry = array_.oldest(line);
    Request request{done, tile_, 0};
    if (array_.dirty(entry)) {
        request.write = array_.line(entry) << line_shift_;
        note_write_back(request.write, column);
    }
    array_.fill(entry, line);
    array_.set_dirty(entry, write);
    if (!needs_data && whole_lines_) {
        if (request.write != Request::nothing)
            leave(request);
        return {done, Cause::l2};
    }
    ++counters_.fills;
    ++cell.memory_reads;
    request.read = line << line_shift_;
    request.ticket = tickets_.open();
    array_.set_in_flight(entry, true);
    if (flights_.size() >= flight_limit_)
        std::erase_if(flights_, [&](const Flight& f) {
            Answered a;
            return is_ticket(f.until) ? tickets_.find(f.until, a) && a.last <= t : f.until <= t;
        });
    flights_.push_back({line, request.ticket});
    leave(request);
    return {request.ticket, Cause::memory};
}

void L2::discard(std::uint64_t address) {
    CacheArray::Entry entry = array_.find(address >> line_shift_);
    if (entry != CacheArray::none && array_.dirty(entry)) {
        array_.set_dirty(entry, false);
        ++counters_.discarded;
    }
}

void L2::invalidate(std::uint64_t address, cycle t, std::size_t column) {
    CacheArray::Entry entry = array_.find(address >> line_shift_);
    if (entry == CacheArray::none)
        return;
    ++counters_.invalidations;
    if (array_.dirty(entry)) {
        std::uint64_t own = array_.line(entry) << line_shift_;
        note_write_back(own, column);
        leave({t, tile_, 0, own});
    }
    array_.drop(entry);
}

} // namespace sim
