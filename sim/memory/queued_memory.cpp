#include "sim/memory/queued_memory.h"

#include "sim/config/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>

namespace sim {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}

} // namespace

QueuedMemory::QueuedMemory(const Config& config)
    : core_ps_(wide(config.chip.clock_ps)), memory_ps_(wide(config.memory.clock_ps)),
      there_(wide(config.memory.controller_cycles) / 2),
      back_(wide(config.memory.controller_cycles) - there_),
      burst_shift_(static_cast<unsigned>(
          std::countr_zero(wide(config.memory.bus_bytes * config.memory.burst_length)))),
      parts_(static_cast<std::uint32_t>(config.last_cache().line_bytes >> burst_shift_)),
      mapping_(config.memory), timing_(config.memory),
      lines_(wide(config.memory.channels * config.memory.ranks)) {
    const MemoryConfig& c = config.memory;
    if (parts_ > c.read_queue || parts_ > c.write_queue)
        throw ConfigError(fmt::format("a line of the L2 is {} bursts, more than memory.{}_queue, {}, holds; "
                                      "make it that many at least",
                                      parts_, parts_ > c.read_queue ? "read" : "write",
                                      parts_ > c.read_queue ? c.read_queue : c.write_queue));
    channels_.reserve(wide(c.channels));
    for (std::uint32_t i = 0; i < wide(c.channels); ++i)
        channels_.emplace_back(i, c, timing_);
    for (DramController& channel : channels_)
        next_.push_back(channel.next_event());
}

bool QueuedMemory::has_room(Column kind, std::uint64_t burst) const {
    auto channel = [&](std::uint32_t part) {
        return mapping_.locate((burst + part) << burst_shift_).channel;
    };
    for (std::uint32_t i = 0; i < parts_; ++i) {
        std::uint32_t c = channel(i);
        if (channels_[c].has_room(kind, parts_))
            continue;
        std::size_t bursts = 0; // of the line, for this channel
        for (std::uint32_t j = 0; j < parts_; ++j)
            bursts += channel(j) == c ? 1 : 0;
        if (!channels_[c].has_room(kind, bursts))
            return false;
    }
    return true;
}

void QueuedMemory::send(Column kind, std::uint64_t address, std::uint64_t id, cycle t) {
    std::uint64_t burst = address >> burst_shift_ & ~std::uint64_t{parts_ - 1};
    for (std::uint32_t i = 0; i < parts_; ++i) {
        DramPlace p = mapping_.locate((burst + i) << burst_shift_);
        if (i == 0) {
            MemoryCounters& n = lines_[p.channel * lines_.size() / channels_.size() + p.rank];
            ++(kind == Column::read ? n.reads : n.writes);
        }
        channels_[p.channel].enqueue(kind, p, burst + i, id, arrival(t));
        collect(channels_[p.channel]);
        next_[p.channel] = channels_[p.channel].next_event();
    }
}

bool QueuedMemory::read(std::uint64_t id, std::uint64_t address, cycle t) {
    advance_to(t);
    if (!has_room(Column::read, address >> burst_shift_ & ~std::uint64_t{parts_ - 1}))
        return false;
    std::uint32_t slot = free_;
    if (slot == none) {
        slot = static_cast<std::uint32_t>(reading_.size());
        reading_.emplace_back();
    } else {
        free_ = reading_[slot].next_free;
    }
    reading_[slot] = {id, number_++, 0, parts_, none};
    send(Column::read, address, slot, t);
    deliver();
    return true;
}

bool QueuedMemory::write(std::uint64_t address, cycle t) {
    advance_to(t);
    if (!has_room(Column::write, address >> burst_shift_ & ~std::uint64_t{parts_ - 1}))
        return false;
    send(Column::write, address, 0, t);
    return true;
}

void QueuedMemory::collect(DramController& c) {
    for (const DramController::Done& d : c.done()) {
        auto slot = static_cast<std::uint32_t>(d.id);
        Line& line = reading_[slot];
        line.last = std::max(line.last, d.at);
        if (--line.left != 0)
            continue;
        answers_.push_back({line.number, {line.id, leave(line.last) + back_}});
        line.next_free = free_;
        free_ = slot;
    }
    c.done().clear();
}

void QueuedMemory::advance_clock(Clock t) {
    for (std::size_t i = 0; i < next_.size(); ++i)
        if (next_[i] < t) {
            channels_[i].advance_to(t);
            collect(channels_[i]);
            next_[i] = channels_[i].next_event();
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
    Clock next = *std::min_element(next_.begin(), next_.end());
    if (next == DramController::never)
        return never;
    // arrival(t) > next
    std::uint64_t t = next * memory_ps_ / core_ps_ + 1;
    return t > there_ ? t - there_ : 0;
}

void QueuedMemory::flush() {
    for (std::size_t i = 0; i < next_.size(); ++i) {
        channels_[i].flush();
        next_[i] = channels_[i].next_event();
    }
}

void QueuedMemory::finish() {
    flush();
    for (DramController& c : channels_) {
        while (!c.empty())
            c.advance_to(c.next_event() + 1);
        for (const MemoryCounters& n : c.counters())
            c.advance_to(n.last_clock);
        collect(c);
        next_[static_cast<std::size_t>(&c - channels_.data())] = c.next_event();
    }
    deliver();
}

std::vector<MemoryCounters> QueuedMemory::rank_counters() const {
    std::vector<MemoryCounters> out = lines_;
    auto to = out.begin();
    for (const DramController& c : channels_)
        for (const MemoryCounters& rank : c.counters())
            *to++ += rank;
    return out;
}

MemoryCounters QueuedMemory::counters() const {
    MemoryCounters sum;
    for (const MemoryCounters& rank : rank_counters())
        sum += rank;
    return sum;
}

void QueuedMemory::set_log(std::vector<DramCommand>* log) {
    for (DramController& c : channels_)
        c.set_log(log);
}

} // namespace sim
