// The memory with queues, and before it the lines that its full queues have refused: they wait in the order
// in which they came, those of each channel by themselves, and go in as soon as there is room. Requests come
// in order of time. Not modelled: that a read of a line which still waits to be written is answered from it.
#pragma once

#include "sim/memory/queued_memory.h"

#include <array>
#include <deque>
#include <vector>

namespace sim {

class WaitingMemory {
public:
    static constexpr cycle never = QueuedMemory::never;
    /// A line read: the core cycle at which its last byte is back. A line written: the one at which the
    /// controller has it.
    using Done = QueuedMemory::Done;

    /// Throws ConfigError as QueuedMemory does.
    explicit WaitingMemory(const Config& config);

    /// A line, by any number that comes back with the answer, at core cycle `t`, no earlier than any call
    /// before.
    void read(std::uint64_t id, std::uint64_t address, cycle t) { send(Column::read, id, address, t); }
    void write(std::uint64_t id, std::uint64_t address, cycle t) { send(Column::write, id, address, t); }
    /// All that is decided before core cycle `t`.
    void advance_to(cycle t);
    /// Whether any answer is not decided yet.
    bool busy() const { return refused_ != 0 || memory_.reading() != 0; }
    /// The first cycle t for which advance_to(t) decides more if nothing else comes.
    cycle next_event() { return memory_.next_event(); }
    /// All that was sent is read and written; nothing may wait. Returns the core cycle after the last data.
    cycle drain() { return memory_.finish(); }
    /// Answers decided since the caller emptied it.
    std::vector<Done>& reads() { return memory_.done(); }
    std::vector<Done>& writes() { return written_; }

    const QueuedMemory& queues() const { return memory_; }

private:
    struct Waiting {
        std::uint64_t id, address;
        cycle since;
    };
    using Line = std::deque<Waiting>;

    void send(Column kind, std::uint64_t id, std::uint64_t address, cycle t);
    bool offer(Column kind, std::uint64_t id, std::uint64_t address, cycle t);
    void admit(cycle t);

    QueuedMemory memory_;
    std::array<std::vector<Line>, 2> waiting_; // by Column, and by channel
    std::size_t refused_ = 0;                  // that wait
    std::vector<Done> written_;
};

} // namespace sim
