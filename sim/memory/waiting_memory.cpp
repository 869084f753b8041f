#include "sim/memory/waiting_memory.h"

namespace sim {

WaitingMemory::WaitingMemory(const Config& config) : memory_(config) {
    for (auto& lines : waiting_)
        lines.resize(static_cast<std::size_t>(config.memory.channels));
}

bool WaitingMemory::offer(Column kind, std::uint64_t id, std::uint64_t address, cycle t) {
    if (kind == Column::read)
        return memory_.read(id, address, t);
    if (!memory_.write(address, t))
        return false;
    written_.push_back({id, memory_.taken(t)});
    return true;
}

void WaitingMemory::send(Column kind, std::uint64_t id, std::uint64_t address, cycle t) {
    advance_to(t);
    Line& line = waiting_[at(kind)][memory_.channel_of(address)];
    if (line.empty() && offer(kind, id, address, t))
        return;
    line.push_back({id, address, t});
    ++refused_;
}

/// Those go in for whom there is room now.
void WaitingMemory::admit(cycle t) {
    for (Column kind : {Column::read, Column::write})
        for (Line& line : waiting_[at(kind)])
            while (!line.empty() && offer(kind, line.front().id, line.front().address, t)) {
                memory_.count_wait(kind, line.front().address, line.front().since, t);
                line.pop_front();
                --refused_;
            }
}

void WaitingMemory::advance_to(cycle t) {
    while (refused_ != 0) {
        const cycle next = memory_.next_event();
        if (next > t)
            break;
        memory_.advance_to(next);
        admit(next);
    }
    memory_.advance_to(t);
}

} // namespace sim
