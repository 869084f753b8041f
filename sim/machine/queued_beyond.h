// Beyond the tiles, with a memory whose controller has queues: a discrete-event simulation in time order. A
// request holds its MSHR or its place in the write-back buffer until memory has decided its answer and the
// answer is there, which may be windows later; those that find none free wait for them, and lines for room in
// memory's queues, each in the order in which they came. At the same cycle memory acts before what lies here,
// and that before new requests. On a coherent machine a request acts when the directory, or the hub of the
// buses, has it; one for a line whose owner is still being answered waits until that is decided, and then
// goes on in the order in which it came.
#pragma once

#include "sim/machine/beyond.h"
#include "sim/memory/waiting_memory.h"

#include <queue>
#include <unordered_map>

namespace sim {

class QueuedBeyond final : public Beyond {
public:
    QueuedBeyond(const Config& config, Reply reply);

    void serve(cycle end) override;
    cycle drain() override;
    void count_from(cycle t) override { memory_.advance_to(t); }
    void finish() override { drain(); }
    cycle next() override;
    MemoryCounters counters() const override { return memory_.queues().counters(); }
    std::vector<MemoryCounters> rank_counters() const override { return memory_.queues().rank_counters(); }

private:
    static constexpr cycle never = ~cycle{0};
    /// Of a tile's exit.
    struct Port {
        std::size_t mshrs, buffers;        // that are free
        std::deque<Request> reads, writes; // that wait for one
    };
    /// What happens here by itself: an MSHR or buffer of an exit is free, a line comes to memory.
    struct Event {
        enum Kind : std::uint8_t { frees_mshr, frees_buffer, reads, writes };
        cycle at;
        std::uint64_t number; // in the order in which they were foreseen
        Kind kind;
        std::uint64_t what; // the exit, or the transfer
        bool operator>(const Event& e) const { return at != e.at ? at > e.at : number > e.number; }
    };
    /// A line that memory is asked for, or given.
    struct Transfer {
        Ways::Asker who;
        std::uint64_t address;
        std::uint32_t bytes; // that come back, or go there
        cycle ticket = 0;    // of a cache here, among tickets_
        Request request{};   // of a tile
        cycle known = 0;     // where caches are coherent: no answer leaves earlier
        cycle since = 0;     // when memory was asked
    };
    /// What a cache here has answered with a ticket.
    struct Unanswered {
        Request request;
        cycle ticket;
    };
    struct MemoryBelow final : Below {
        MemoryBelow(QueuedBeyond& b, std::uint32_t cache) : beyond(b), who{Ways::Asker::cache, cache} {}
        Answer read(const Access& a) override {
            return {beyond.send_for(who, a, Event::reads), Cause::memory};
        }
        Answer write(const Access& a) override {
            return {beyond.send_for(who, a, Event::writes), Cause::memory};
        }
        QueuedBeyond& beyond;
        Ways::Asker who;
    };

    Below& memory_below(std::uint32_t cache) override { return below_.emplace_back(*this, cache); }
    void foresee(cycle at, Event::Kind kind, std::uint64_t what) {
        events_.push({at, foreseen_++, kind, what});
    }
    cycle send_for(Ways::Asker cache, const Access& a, Event::Kind kind);
    void send(cycle t, Event::Kind kind, const Transfer& line);
    void come(cycle there, Event::Kind kind, const Transfer& line);
    void act(const Event& e);
    void act(const Request& r);
    void claim(Request r);
    bool grants_silently(const Request& r);
    void next_waiting(std::size_t port, bool mshr);
    bool is_blocked(const Request& r);
    void ask_others(const Request& r);
    void write_owners(const Request& r);
    void wake();
    void want_buffer(const Request& r);
    void want_mshr(const Request& r);
    void enter_buffer(Request r);
    void enter_mshr(Request r);
    void look_up(Request r);
    void answer(const Request& r, Answer a);
    void reply(const Request& r, Answer a);
    void take_answers();

    std::uint64_t shortest_; // core cycles of a read of memory
    WaitingMemory memory_;
    std::deque<MemoryBelow> below_; // by cache
    std::vector<Port> ports_;       // by tile and exit
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    std::uint64_t foreseen_ = 0;
    std::vector<Transfer> transfers_;
    std::vector<std::uint64_t> free_; // of these
    std::vector<Unanswered> unanswered_;
    // Of a coherent machine, by line: what waits until it is known when the line's owner has it, and the
    // lines of which that is known now.
    std::unordered_map<std::uint64_t, std::vector<Request>> blocked_;
    std::vector<std::uint64_t> known_;
};

} // namespace sim
