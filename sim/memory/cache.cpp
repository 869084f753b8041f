#include "sim/memory/cache.h"

#include <algorithm>

namespace sim {
namespace {

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}
unsigned log2(integer x) {
    return static_cast<unsigned>(std::countr_zero(wide(x)));
}

} // namespace

Cache::Cache(const CacheConfig& config, unsigned level, bool last, const cycle& earliest, Below& below,
             Tickets& tickets, Attribution& attribution)
    : line_shift_(log2(config.line_bytes)), bank_shift_(level == 0 ? 0 : log2(config.bank_bytes)),
      latency_(wide(config.latency)), bank_mask_(level == 0 ? 0 : wide(config.banks) - 1), last_(last),
      cause_(static_cast<Cause>(static_cast<unsigned>(Cause::l1) + level)), traffic_(traffic_of_level[level]),
      array_(wide(config.size_bytes / (config.ways * config.line_bytes)), wide(config.ways),
             replacement_of(config.replacement)),
      banks_(level == 0 ? 0 : wide(config.banks), Calendar("cache bank", earliest)),
      mshrs_(wide(config.mshrs), tickets), write_backs_(wide(config.write_back_buffer), tickets),
      tickets_(tickets), below_(below), attribution_(attribution) {
    if (last)
        mshrs_.lift_limit();
}

/// An access that found its line on its way there.
Answer Cache::in_flight(CacheArray::Entry entry, std::uint64_t line, Answer present) {
    Pool::Hold* hold = mshrs_.find(line);
    if (hold == nullptr) {
        array_.set_in_flight(entry, false);
        return present;
    }
    if (is_ticket(hold->until)) { // the line may be there before the access
        ++counters_.hits_in_flight;
        return {tickets_.no_earlier(hold->until, present.ready, present.from), hold->cause};
    }
    if (hold->until > present.ready) {
        ++counters_.hits_in_flight;
        return {hold->until, hold->cause};
    }
    array_.set_in_flight(entry, false);
    return present;
}

/// Sends a dirty line on its way, from the buffer that it has entered at `t`. Returns 0, or when to try
/// again.
cycle Cache::write_back(CacheArray::Entry entry, cycle t, cycle down, std::size_t column, bool followed,
                        bool forced) {
    std::uint64_t line = array_.line(entry);
    std::uint64_t address = line << line_shift_;
    Answer accepted =
        below_.write({address, std::uint32_t{1} << line_shift_, down, column, true, followed, forced});
    if (accepted.retry != 0)
        return accepted.retry;
    ++counters_.write_backs;
    ++(attribution_.cell(address, column).*traffic_.write_backs);
    if (!last_)
        write_backs_.hold({line, t, accepted.ready, Cause::mshrs});
    return 0;
}

/// Reads the line from below, which is asked at `down`. Whoever was there is written back if it is dirty.
Answer Cache::fill(std::uint64_t line, cycle t, cycle down, std::size_t column) {
    CacheArray::Entry entry = array_.victim(line);
    cycle retry = 0;
    if (!last_ && (retry = mshrs_.take(t)) != t)
        return Answer::later(retry);
    if (array_.dirty(entry)) {
        if (!last_ && (retry = write_backs_.take(t)) != t)
            return Answer::later(retry);
        if (retry = write_back(entry, down, down, column, true, false); retry != 0)
            return Answer::later(retry);
        array_.set_dirty(entry, false);
    }
    Answer below = below_.read({line << line_shift_, std::uint32_t{1} << line_shift_, down, column});
    if (below.retry != 0)
        return below;
    ++counters_.fills;
    mshrs_.hold({line, t, below.ready, below.from});
    array_.fill(entry, line);
    array_.set_in_flight(entry, true);
    return below;
}

void Cache::prefetch(std::uint64_t address, cycle t, std::size_t column) {
    std::uint64_t line = address >> line_shift_;
    if (array_.find(line) != CacheArray::none)
        return;
    if (fill(line, t, t + latency_, column).retry != 0)
        ++counters_.prefetches_dropped;
    else
        ++counters_.prefetches;
}

Answer Cache::serve(const Access& a, bool write) {
    std::uint64_t line = a.address >> line_shift_;
    std::uint32_t slots = (a.bytes + (1U << bank_shift_) - 1) >> bank_shift_;
    Calendar& bank = banks_[line & bank_mask_];
    cycle start = bank.find_run(a.at, slots);
    Answer answer{start + latency_, cause_};
    CacheArray::Entry entry = array_.find(line);
    if (entry != CacheArray::none) {
        ++counters_.hits;
        array_.touch(entry);
        if (write)
            array_.set_dirty(entry, true);
        if (array_.in_flight(entry)) [[unlikely]]
            answer = in_flight(entry, line, answer);
    } else {
        answer = miss(a, line, write, answer.ready);
        if (answer.retry != 0)
            return answer;
    }
    bank.mark_run(start, slots);
    quiet_ = std::max(quiet_, start + slots);
    Traffic& cell = attribution_.cell(a.address, a.column);
    ++(write ? counters_.writes : counters_.reads);
    ++(cell.*(write ? traffic_.writes : traffic_.reads));
    counters_.busy_cycles += slots;
    return answer;
}

Answer Cache::miss(const Access& a, std::uint64_t line, bool write, cycle done) {
    Answer answer{done, cause_};
    if (write && a.whole && a.bytes >> line_shift_ != 0) { // all of the line comes from above
        CacheArray::Entry entry = array_.victim(line);
        if (array_.dirty(entry))
            write_back(entry, done, done, a.column, false, a.forced);
        array_.fill(entry, line);
    } else {
        answer = fill(line, a.at, done, a.column);
        if (answer.retry != 0)
            return answer;
    }
    array_.set_dirty(array_.find(line), write);
    ++counters_.misses;
    ++(attribution_.cell(a.address, a.column).*traffic_.misses);
    return answer;
}

void Cache::invalidate(std::uint64_t address, cycle t, std::size_t column) {
    CacheArray::Entry entry = array_.find(address >> line_shift_);
    if (entry == CacheArray::none)
        return;
    ++counters_.invalidations;
    if (array_.dirty(entry))
        write_back(entry, t, t, column, false, true);
    array_.drop(entry);
}

void Cache::discard(std::uint64_t address) {
    CacheArray::Entry entry = array_.find(address >> line_shift_);
    if (entry != CacheArray::none && array_.dirty(entry)) {
        array_.set_dirty(entry, false);
        ++counters_.discarded;
    }
}

} // namespace sim
