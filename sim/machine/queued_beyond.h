// Beyond the tiles, with a memory whose controller has queues: a discrete-event simulation in time order. A
// request holds its MSHR or its place in the write-back buffer until memory has decided its answer and the
// answer is there, which may be windows later; those that find none free wait for them, and lines for room in
// memory's queues, each in the order in which they came. Messages take links of the network when they come
// there (flights.h), those of a directory or hub too: what it waits for happens when they are there. At the
// same cycle memory acts before what lies here, that before new requests, and these before messages. On a
// coherent machine a request acts when the directory, or the hub of the buses, has it; one for a line whose
// owner is still being answered waits until that is decided, and then goes on in the order in which it came.
#pragma once

#include "sim/machine/beyond.h"
#include "sim/memory/waiting_memory.h"
#include "sim/network/flights.h"

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
    void ask_memory(bool write, std::uint64_t address, cycle t) override;
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
    /// What happens here by itself: an MSHR or buffer of an exit is free, a line comes to memory, or a
    /// request to a bank.
    struct Event {
        enum Kind : std::uint8_t { frees_mshr, frees_buffer, reads, writes, takes_bank };
        cycle at;
        std::uint64_t number; // in the order in which they were foreseen
        Kind kind;
        std::uint64_t what; // the exit, or the transfer
        bool operator>(const Event& e) const { return at != e.at ? at > e.at : number > e.number; }
    };
    /// What is on its way over the network, or in memory.
    struct Transfer {
        enum Goes : std::uint8_t { to_be_read, to_be_written, to_a_bank, on, word, back, unasked } goes;
        Ways::Asker who{};
        std::uint64_t address = 0;
        std::uint32_t bytes = 0; // that come back, or go there
        cycle ticket = 0;        // of a cache here, among tickets_
        Request request{};       // of a tile
        Cause from = Cause::memory;
        // Of a cache's: whose traffic it is.
        Attribution* attribution = nullptr;
        std::size_t column = 0;
    };
    /// Where caches are coherent: what others say of a line that comes from below, and which answer waits
    /// for that, by Request::decision.
    struct Decision {
        bool over = false; // all of it is known:
        Coherence::Outcome out{};
        std::uint64_t leaves = nothing; // the answer, a transfer, which would leave at ...
        bool is_back = false;           // the line is there since ...
        cycle at = 0;
        Cause from = Cause::memory;
    };
    static constexpr std::uint64_t nothing = ~std::uint64_t{0};
    /// What a cache here has answered with a ticket.
    struct Unanswered {
        Request request;
        cycle ticket;
    };
    class MemoryBelow final : public MemoryPort {
    public:
        MemoryBelow(QueuedBeyond& beyond, std::uint32_t cache) : MemoryPort(cache), beyond_(beyond) {}

    private:
        Answer read(const Access& a, Attribution& attribution) override {
            return {beyond_.send_for(who_, a, Transfer::to_be_read, attribution), Cause::memory};
        }
        Answer write(const Access& a, Attribution& attribution) override {
            return {beyond_.send_for(who_, a, Transfer::to_be_written, attribution), Cause::memory};
        }
        QueuedBeyond& beyond_;
    };

    MemoryPort& memory_below(std::uint32_t cache) override { return below_.emplace_back(*this, cache); }
    void send_on(const Request& r, const Ways::Leg& leg, cycle t) override {
        leave(keep({.goes = Transfer::on, .request = r}), leg, t);
    }
    void send_to_bank(const Request& r, const Ways::Leg& leg, cycle t) override {
        leave(keep({.goes = Transfer::to_a_bank, .request = r}), leg, t);
    }
    void come_to_bank(const Request& r, cycle t) override {
        foresee(t, Event::takes_bank, keep({.goes = Transfer::to_a_bank, .request = r}));
    }
    void send_word(const Ways::Leg& leg, cycle t, const Coherence::Arrives& arrives) override {
        const std::uint64_t word = keep({.goes = Transfer::word});
        arrives_.resize(transfers_.size());
        arrives_[word] = arrives;
        leave(word, leg, t);
    }
    void foresee(cycle at, Event::Kind kind, std::uint64_t what) {
        events_.push({at, foreseen_++, kind, what});
    }
    std::uint64_t keep(const Transfer& transfer);
    void leave(std::uint64_t transfer, const Ways::Leg& leg, cycle t);
    void arrive(std::uint64_t transfer, cycle there);
    cycle send_for(Ways::Asker cache, const Access& a, Transfer::Goes goes, Attribution& attribution);
    void note_at_memory(const Transfer& line);
    void send(const Transfer& line, cycle t);
    void send_back(std::uint64_t transfer, cycle t);
    void act(const Event& e);
    void act(const Request& r);
    void claim(Request r);
    bool grants_silently(const Request& r);
    void next_waiting(std::size_t port, bool mshr);
    bool is_blocked(const Request& r);
    void ask_others(Request r);
    void ask_below(const Request& r, cycle t);
    void send_when_known(std::uint64_t transfer, const Request& r, cycle t);
    std::uint32_t new_decision();
    void is_over(const Request& r, const Coherence::Outcome& out);
    void write_owners(const Request& r);
    void wake();
    void want_buffer(const Request& r);
    void want_mshr(const Request& r);
    void enter_buffer(Request r);
    void enter_mshr(Request r);
    void look_up(Request r);
    void answer(const Request& r, const Answer& a);
    void is_back(const Request& r, const Answer& a);
    void reply(const Request& r, const Answer& a);
    void take_answers();
    void answer_ticket(cycle ticket, const Answer& a) {
        tickets_.answer(ticket, a.ready, a.from);
        lines_came_ = true;
    }
    void take_lines();

    std::uint64_t unknown_; // core cycles until a line may be here of which it is not known when
    WaitingMemory memory_;
    Flights flights_;
    std::deque<MemoryBelow> below_; // by cache
    std::vector<Port> ports_;       // by tile and exit
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    std::uint64_t foreseen_ = 0;
    std::vector<Transfer> transfers_;
    std::vector<std::uint64_t> free_; // of these
    std::vector<Unanswered> unanswered_;
    bool lines_came_ = false;                 // some of these are answered
    std::vector<Coherence::Arrives> arrives_; // of words, by transfer
    std::vector<Decision> decisions_;
    std::vector<std::uint32_t> free_decisions_;
    // Of a coherent machine, by line: what waits until it is known when the line's owner has it, and the
    // lines of which that is known now.
    std::unordered_map<std::uint64_t, std::vector<Request>> blocked_;
    std::vector<std::uint64_t> known_;
};

} // namespace sim
