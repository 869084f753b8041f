// Beyond the tiles, with a memory that answers at once: when a request is served, all its times are known.
#pragma once

#include "sim/machine/beyond.h"
#include "sim/memory/memory.h"
#include "sim/memory/pool.h"

#include <optional>
#include <unordered_map>

namespace sim {

class ImmediateBeyond final : public Beyond {
public:
    ImmediateBeyond(const Config& config, Reply reply);

    void serve(cycle end) override;
    cycle drain() override { return std::max({served_, ways_.network().quiet(), memory_.drain()}); }
    void count_from(cycle t) override;
    void finish() override { memory_.finish(); }
    void ask_memory(bool write, std::uint64_t address, cycle t) override {
        t = ways_.in_order(t);
        if (write)
            memory_.write(address, t);
        else
            memory_.read(address, t);
    }
    cycle next() override { return waiting_.empty() ? ~cycle{0} : waiting_.front().at; }
    MemoryCounters counters() const override { return memory_.counters(); }
    std::vector<MemoryCounters> rank_counters() const override { return memory_.rank_counters(); }

private:
    class MemoryBelow final : public MemoryPort {
    public:
        MemoryBelow(ImmediateBeyond& beyond, std::uint32_t cache) : MemoryPort(cache), beyond_(beyond) {}

    private:
        Answer read(const Access& a, Attribution& attribution) override {
            Ways& ways = beyond_.ways_;
            const cycle there = ways.ask(who_, a.address, a.at);
            const cycle ready = beyond_.read_memory(attribution, a.address, a.bytes, there, a.column);
            return {ways.answer(who_, a.address, a.bytes, ready), Cause::memory};
        }
        Answer write(const Access& a, Attribution& attribution) override {
            const cycle there = beyond_.ways_.write(who_, a.address, a.bytes, a.at);
            return {beyond_.write_memory(attribution, a.address, a.bytes, there, a.column), Cause::memory};
        }
        ImmediateBeyond& beyond_;
    };
    /// Requests of one exit that wait for an entry of a pool whose times are known. They have it in the order
    /// of their sequence: the first is among all that are to be served, at the cycle from which on one is
    /// free.
    struct Queue {
        std::vector<Request> behind; // a heap by sequence, the others
        std::uint64_t first = no_sequence;
    };
    static constexpr std::uint64_t no_sequence = ~std::uint64_t{0};
    struct Port {
        OrderedPool mshrs, write_backs;
        Queue for_mshr{}, for_buffer{};
        // Heaps by sequence, as requests left: of those that wait until it is known when a place in the
        // buffer, or an MSHR, is free.
        std::vector<Request> until_buffer{}, until_mshr{};
    };
    MemoryPort& memory_below(std::uint32_t cache) override { return below_.emplace_back(*this, cache); }
    /// A line that is at memory at cycle `t`.
    cycle read_memory(Attribution& of, std::uint64_t address, std::uint32_t bytes, cycle t,
                      std::size_t column) {
        of.note_memory(traces::Kind::read, address, bytes, t, column);
        return memory_.read(address, t);
    }
    cycle write_memory(Attribution& of, std::uint64_t address, std::uint32_t bytes, cycle t,
                       std::size_t column) {
        of.note_memory(traces::Kind::write, address, bytes, t, column);
        return memory_.write(address, t);
    }
    void send_on(const Request& r, const Ways::Leg& leg, cycle t) override;
    void send_to_bank(const Request& r, const Ways::Leg& leg, cycle t) override {
        take_bank(r, ways_.send(leg, t));
    }
    void come_to_bank(const Request& r, cycle t) override { take_bank(r, t); }
    void send_word(const Ways::Leg& leg, cycle t, const Coherence::Arrives& arrives) override {
        arrives(ways_.send(leg, t));
    }
    Coherence::Outcome ask_others(const Request& r, cycle t);
    void serve_from_memory(Request r);
    void wait(Queue& queue, Request r, cycle until);
    void leave(Queue& queue, const Request& r, OrderedPool& pool);
    bool serves_alone(const Request& r);
    Answer read_coherently(const Request& r);
    void serve_from_cache(Request r);
    void arrive(Request r);
    /// The request's entry of the pool, held until it is closed; nothing: the request comes again when one is
    /// free.
    std::optional<std::size_t> take(OrderedPool& pool, const Request& request);
    void let_next_try(std::vector<Request>& waiting, cycle free);
    void write(Request r);
    void read(Request r);
    void look_for_owner(Request r);
    void line_is_known(const Request& r);
    void answer(const Request& r, const Answer& a);

    std::vector<Port> ports_; // by tile and exit
    Memory memory_;
    std::deque<MemoryBelow> below_; // by cache
    // On buses above a cache, by line: what waits until it is known when the line's owner has it.
    std::unordered_map<std::uint64_t, std::vector<Request>> blocked_;
};

} // namespace sim
