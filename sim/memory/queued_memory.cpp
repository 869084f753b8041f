#include "sim/memory/queued_memory.h"

#include "sim/config/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace sim {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

} // namespace

std::string QueuedMemory::mistake(const Config& config) {
    const MemoryConfig& c = config.memory;
    const integer parts = config.last_cache().line_bytes / (c.bus_bytes * c.burst_length);
    if (parts > c.read_queue)
        return fmt::format("memory.read_queue is {}, but a line of the last cache is {} bursts; make it that "
                           "many at least",
                           c.read_queue, parts);
    if (parts > c.write_queue - c.write_low) // no more are sent than down to write_low
        return fmt::format("memory.write_queue is {}, {} more than memory.write_low, but a line of the last "
                           "cache is {} bursts; make it {} at least",
                           c.write_queue, c.write_queue - c.write_low, parts, c.write_low + parts);
    return "";
}

QueuedMemory::QueuedMemory(const Config& config) : MemoryLines(config), shortest_(shortest_read(config)) {
    if (const std::string what = mistake(config); !what.empty())
        throw ConfigError(what);
    const MemoryConfig& c = config.memory;
    channels_.reserve(wide(c.channels));
    for (std::uint32_t i = 0; i < wide(c.channels); ++i)
        channels_.emplace_back(i, c, timing_);
    for (DramController& channel : channels_)
        next_.push_back(channel.next_event());
    soonest_ = *std::min_element(next_.begin(), next_.end());
    places_.resize(parts_);
}

bool QueuedMemory::has_room(Column kind, std::uint64_t burst) {
    for (std::uint32_t i = 0; i < parts_; ++i)
        places_[i] = place(burst + i);
    for (const DramPlace& p : places_) {
        if (channels_[p.channel].has_room(kind, parts_))
            continue;
        std::size_t bursts = 0; // of the line, for this channel
        for (const DramPlace& other : places_)
            bursts += other.channel == p.channel ? 1 : 0;
        if (!channels_[p.channel].has_room(kind, bursts))
            return false;
    }
    return true;
}

/// What has_room() was asked of, at clock `t`.
void QueuedMemory::send(Column kind, std::uint64_t burst, std::uint64_t id, Clock t) {
    MemoryCounters& n = counters_of(places_[0]);
    ++(kind == Column::read ? n.reads : n.writes);
    for (const DramPlace& p : places_) {
        DramController& channel = channels_[p.channel];
        channel.enqueue(kind, p, burst++, id, t);
        collect(channel);
        set_next(p.channel, channel.next_event());
    }
}

void QueuedMemory::set_next(std::size_t channel, Clock t) {
    const Clock old = std::exchange(next_[channel], t);
    if (t < soonest_)
        soonest_ = t;
    else if (old == soonest_ && t != old)
        soonest_ = *std::min_element(next_.begin(), next_.end());
}

bool QueuedMemory::read(std::uint64_t id, std::uint64_t address, cycle t) {
    const Clock clock = arrival(t);
    const std::uint64_t burst = first_burst(address);
    advance_clock(clock);
    if (!has_room(Column::read, burst))
        return false;
    std::uint32_t slot = free_;
    if (slot == none) {
        slot = static_cast<std::uint32_t>(reading_.size());
        reading_.emplace_back();
    } else {
        free_ = reading_[slot].next_free;
    }
    reading_[slot] = {id, number_++, t + shortest_, 0, parts_, none};
    ++undecided_;
    send(Column::read, burst, slot, clock);
    deliver();
    return true;
}

bool QueuedMemory::write(std::uint64_t address, cycle t) {
    const Clock clock = arrival(t);
    const std::uint64_t burst = first_burst(address);
    advance_clock(clock);
    if (!has_room(Column::write, burst))
        return false;
    send(Column::write, burst, 0, clock);
    return true;
}

void QueuedMemory::collect(DramController& c) {
    for (const DramController::Done& d : c.done()) {
        auto slot = static_cast<std::uint32_t>(d.id);
        Line& line = reading_[slot];
        line.last = std::max(line.last, d.at);
        if (--line.left != 0)
            continue;
        answers_.push_back({line.number, {line.id, std::max(leave(line.last) + back_, line.least)}});
        --undecided_;
        line.next_free = free_;
        free_ = slot;
    }
    c.done().clear();
}

void QueuedMemory::advance_clock(Clock t) {
    if (soonest_ >= t)
        return;
    soonest_ = DramController::never;
    for (std::size_t i = 0; i < next_.size(); ++i) {
        if (next_[i] < t) {
            channels_[i].advance_to(t);
            collect(channels_[i]);
            next_[i] = channels_[i].next_event();
        }
        soonest_ = std::min(soonest_, next_[i]);
    }
    deliver();
}

void QueuedMemory::deliver() {
    if (answers_.size() > 1)
        std::sort(answers_.begin(), answers_.end(), [](const Answer& a, const Answer& b) {
            return a.done.at != b.done.at ? a.done.at < b.done.at : a.number < b.number;
        });
    for (const Answer& a : answers_)
        done_.push_back(a.done);
    answers_.clear();
}

void QueuedMemory::advance_to(cycle t) {
    advance_clock(arrival(t));
}

cycle QueuedMemory::next_event() {
    return soonest_ == DramController::never ? never : first_after(soonest_);
}

void QueuedMemory::flush() {
    for (std::size_t i = 0; i < next_.size(); ++i) {
        channels_[i].flush();
        set_next(i, channels_[i].next_event());
    }
}

cycle QueuedMemory::finish() {
    flush();
    Clock end = 0;
    for (DramController& c : channels_) {
        while (!c.empty())
            c.advance_to(c.next_event() + 1);
        for (const MemoryCounters& n : c.counters()) {
            c.advance_to(n.last_clock);
            end = std::max(end, n.last_clock);
        }
        collect(c);
        set_next(static_cast<std::size_t>(&c - channels_.data()), c.next_event());
    }
    deliver();
    return leave(end);
}

void QueuedMemory::count_wait(Column kind, std::uint64_t address, cycle since, cycle until) {
    MemoryCounters& n = counters_of(place(first_burst(address)));
    (kind == Column::read ? n.read_wait_clocks : n.write_wait_clocks) +=
        (arrival(until) - arrival(since)) * parts_;
}

void QueuedMemory::set_log(std::vector<DramCommand>* log) {
    for (DramController& c : channels_)
        c.set_log(log);
}

} // namespace sim
