// One run: all state of the machine, and what the timing port does with it.
// Not modelled: instruction fetch, TLBs, order between a load and an earlier store to the same place inside
// an issue window, coherence beyond shared words.
#pragma once

#include "sim/core/core.h"
#include "sim/core/hart.h"
#include "sim/core/sites.h"
#include "sim/machine/machine.h"
#include "sim/machine/published.h"
#include "sim/machine/scheduler.h"

#include <deque>
#include <memory>

namespace sim {

using isa::timing::operation;
using isa::timing::site;
using isa::timing::stamp;

inline constexpr std::uint32_t width = ISA_WIDTH; // logical lanes

/// When the first and the last machine instruction of an operation issued.
struct Issued {
    cycle first, last;
};

class Engine {
public:
    Engine(const Config& config, const isa::address_space& space, int workers,
           const std::vector<std::string>& phases, const std::function<void(int)>& worker);
    Report run();

    // --- operations, by the hart that runs them
    stamp compute(Hart& h, int kind, std::uint32_t instructions, Due ready, bool vector);
    void branch(Hart& h, site where, Due ready, bool taken);
    stamp load(Hart& h, const void* p, std::uint32_t bytes, Due ready, bool vector);
    stamp load_vector(Hart& h, const void* p, std::uint64_t lanes, Due ready);
    void store(Hart& h, const void* p, std::uint32_t bytes, Due ready);
    void store_vector(Hart& h, const void* p, std::uint64_t lanes, Due ready);
    stamp gather(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready);
    void scatter(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready);
    void prefetch(Hart& h, const void* p, Due ready);
    void discard(Hart& h, const void* p, std::uint32_t bytes, Due ready);
    void before_atomic(Hart& h, isa::timing::atomic kind, Due ready);
    stamp after_atomic(Hart& h, isa::timing::atomic kind, const void* p, bool wrote);
    stamp wait_while(Hart& h, const std::int32_t* p, std::int32_t value, Due ready);
    void request_page(Hart& h, isa::page_service& service, std::int32_t space, std::int32_t kind,
                      std::int32_t index);
    std::size_t set_phase(Hart& h, std::size_t phase);

    // --- operands (rules 1 and 3): each makes `ready` no earlier than the operand
    Due begin(Hart& h) const { return later(h.bound, h.window[h.position]); }
    static Due later(Due a, Due b) {
        a.later(b);
        return a;
    }
    void need_scalar(Due& ready, const stamp& s) const {
        ready.later(Due(s.last, static_cast<Cause>(s.cause)));
    }
    void need_all(Hart& h, Due& ready, const stamp& s) {
        need_register(h, ready, s);
        need_scalar(ready, s);
    }
    void need_lanes(Hart& h, Due& ready, const stamp& s) {
        need_register(h, ready, s);
        cycle follow = s.last > span_ - 1 ? s.last - (span_ - 1) : 0;
        ready.later(Due(std::max(s.first, follow), static_cast<Cause>(s.cause)));
    }
    std::uint32_t vector_instructions() const { return pieces_; }

private:
    struct Data {
        cycle first = ~cycle{0}, last = 0, granted = 0;
        Cause from = Cause::l1;
    };
    void need_register(Hart& h, Due& ready, const stamp& s) {
        if (s.value != 0 && registers_) {
            RegisterFile::Use where = h.registers.use(s.value);
            if (where != RegisterFile::Use::resident) [[unlikely]]
                reload(h, ready, s.value, where == RegisterFile::Use::unstored);
        }
    }
    void reload(Hart& h, Due& ready, std::uint32_t value, bool unstored);
    cycle turn(Hart& h, cycle t);
    cycle hold_core(Hart& h, cycle t);
    Issued issue(Hart& h, int kind, std::uint32_t instructions, Due ready);
    void finish_issue(Hart& h, Issued at, cycle granted);
    void charge_overhead(Hart& h, Due ready);
    void count(Hart& h, std::uint32_t instructions, bool vector);
    void touch(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write, cycle from, Data& data);
    void touch_line(Hart& h, std::uint64_t line, bool write, std::uint32_t accesses, std::uint32_t slots,
                    cycle from, Data& data);
    Data touch_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, bool write, cycle from);
    Data touch_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                       bool write, cycle from);
    std::uint32_t indexed_instructions(std::uint64_t lanes) const;
    void stored(Hart& h, const Data& data);
    void publish(Hart& h, std::uint64_t address, cycle written, cycle visible);
    void check_visible(Hart& h, std::uint64_t address, cycle t, Due& ready);
    std::uint64_t address(const void* p) const {
        auto a = static_cast<std::uint64_t>(static_cast<const std::byte*>(p) - base_);
        if (a >= attribution_.spill_begin()) [[unlikely]]
            outside(p);
        return a;
    }
    [[noreturn]] static void outside(const void* p);
    std::string describe_deadlock() const;
    Report report(int workers, const std::vector<std::string>& phases) const;

    // --- constants of the machine, in the types that the hot paths want
    Config config_;
    std::uint32_t pieces_;      // machine instructions of a vector operation
    std::uint32_t piece_lanes_; // logical lanes of one of them
    std::uint32_t span_;        // cycles in which they can issue at the least
    unsigned issue_shift_, port_shift_;
    std::uint32_t port_bytes_, line_bytes_;
    unsigned line_shift_;
    std::array<std::uint32_t, class_count> latency_{}, interval_{};
    std::uint32_t overhead_; // 1/1024 instructions
    bool registers_, lane_gather_, hold_policy_;
    enum class Prediction { counters, none, perfect } prediction_;

    const std::byte* base_;
    std::uint64_t reach_; // cycles that an operation may lie behind its thread's latest turn
    std::uint64_t ring_;  // cycles by which one thread's operations may lie behind another's bookings
    const isa::address_space& space_;
    Attribution attribution_;
    Memory memory_;
    L2 l2_;
    std::deque<Core> cores_;
    std::deque<Hart> harts_;
    Sites sites_;
    Published published_;
    Scheduler scheduler_;
    std::vector<Hart*> sleepers_;
    int workers_;
    std::vector<std::string> phases_;
};

/// The run and the hardware thread that the port acts for; null outside a run.
extern Engine* running_engine;
extern Hart* running_hart;

} // namespace sim
