// One run: all state of the machine, and what the timing port does with it. Time advances in windows: every
// tile runs to the window's end by itself; what left it is served then, in order of time. Not modelled:
// instruction fetch, order between a load and an earlier store to the same place inside
// an issue window.
#pragma once

#include "isa/services.h"
#include "sim/core/pairing.h"
#include "sim/machine/asides.h"
#include "sim/machine/beyond.h"
#include "sim/machine/homes.h"
#include "sim/machine/host_threads.h"
#include "sim/machine/machine.h"
#include "sim/machine/sampler.h"
#include "sim/machine/tile.h"
#include "sim/machine/windows.h"
#include "sim/machine/word_moves.h"
#include "sim/memory/page_tables.h"
#include "sim/trace/tile_progress.h"
#include "traces/description.h"

#include <deque>
#include <memory>
#include <optional>
#include <random>

namespace sim {

using isa::timing::operation;
using isa::timing::site;
using isa::timing::stamp;

inline constexpr std::uint32_t width = ISA_WIDTH; // logical lanes
inline constexpr std::uint64_t all_lanes = ~std::uint64_t{0} >> (64U - width);

inline std::uint32_t narrow(integer x) {
    return static_cast<std::uint32_t>(x);
}

/// When the first and the last machine instruction of an operation issued.
struct Issued {
    cycle first, last;
};

class Engine {
public:
    Engine(const Config& config, const isa::address_space& space, int workers, const Labels& labels,
           int host_threads, const RunOptions& options, const std::function<void(int)>& worker);
    Report run();
    /// What a sampled run estimates; after run().
    Estimate estimate() const;

    // --- operations, by the hart that runs them (compute.cpp, access.cpp, shared_words.cpp)
    stamp compute(Hart& h, std::size_t kind, std::uint32_t instructions, Due ready, bool vector);
    stamp compute_scalar(Hart& h, std::size_t kind, Due ready);
    void branch(Hart& h, site where, Due ready, bool taken);
    stamp load(Hart& h, const void* p, std::uint32_t bytes, Due ready, bool vector);
    stamp load_vector(Hart& h, const void* p, std::uint64_t lanes, bool masked, Due ready);
    void store(Hart& h, const void* p, std::uint32_t bytes, Due ready);
    void store_vector(Hart& h, const void* p, std::uint64_t lanes, bool masked, Due ready);
    stamp gather(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready);
    void scatter(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready);
    void prefetch(Hart& h, const void* p, Due ready);
    void discard(Hart& h, const void* p, std::uint32_t bytes, Due ready);
    void before_atomic(Hart& h, isa::timing::atomic kind, const void* p, Due ready, bool waits = false);
    stamp after_atomic(Hart& h, isa::timing::atomic kind, const void* p, bool wrote);
    stamp wait_while(Hart& h, const std::int32_t* p, std::int32_t value, Due ready);
    void request_page(Hart& h, isa::page_service& service, std::int32_t space, std::int32_t kind,
                      std::int32_t index);
    std::size_t set_phase(Hart& h, std::size_t phase);
    std::size_t set_kind(Hart& h, std::size_t kind);
    // --- whom work is for (owners.cpp)
    std::size_t set_owners(Hart& h, const std::int32_t* owner, std::uint64_t lanes);
    std::size_t narrow_owners(Hart& h, std::uint64_t lanes);
    void restore_owners(Hart& h, std::size_t before);
    void note_level(Hart& h, const void* p, std::uint64_t bytes, int level) const;
    void note_level_of(Hart& h, const void* p, std::uint64_t bytes, const void* other) const;
    /// Returns when the ticket is answered.
    Answered await(Hart& h, cycle ticket);

    /// The operation at hand stands there in the program.
    void note_site(Hart& h, site where) const {
        if (notes_sites_) [[unlikely]] {
            h.site = {SiteAtHand::unnumbered, true};
            h.place = where;
        }
        note_trace_site(h, where);
    }
    void note_trace_site(Hart& h, site where) const {
        if (recorder_ != nullptr) [[unlikely]]
            h.trace_site = h.tile->tap->site_number(where);
    }

    // --- operands (rules 1 and 3): each makes `ready` no earlier than the operand, or notes that its time is
    // open. `span`: in how many cycles the operation can issue at the least
    Due begin(Hart& h) const { return later(h.bound, *h.oldest); }
    static Due later(Due a, Due b) {
        a.later(b);
        return a;
    }
    void need_scalar(Hart& h, Due& ready, const stamp& s) {
        if (is_ticket(s.last)) [[unlikely]]
            ready = need_open(h, ready, s, 0);
        else
            ready.later(Due(s.last, static_cast<Cause>(s.cause)));
    }
    /// The address of a load or store: what was folded into it is there when its operands are.
    void need_address(Hart& h, Due& ready, const stamp& s) {
        if (is_folded(s)) [[unlikely]]
            need_operands(h, ready, s);
        else
            need_scalar(h, ready, s);
    }
    /// Whether the vectors among these operands are in registers, all of which are used then.
    template <class... Stamp> bool in_registers(Hart& h, const Stamp&... s) {
        return !registers_ || (!by_register_ && h.registers.use_all(s.value...));
    }
    /// What needs a vector's last sub-vector: of one that is in a register, or to be brought there.
    void need_last(Hart& h, Due& ready, const stamp& s, std::uint32_t span, bool there) {
        if (!there)
            need_register(h, ready, s, span);
        need_scalar(h, ready, s);
    }
    /// ... and what follows it sub-vector by sub-vector.
    void need_lanes(Hart& h, Due& ready, const stamp& s, std::uint32_t span, bool there) {
        if (!there)
            need_register(h, ready, s, span);
        if (is_ticket(s.last)) [[unlikely]]
            ready = need_open(h, ready, s, span);
        else
            ready.later(Due(follow(s.first, s.last, span), static_cast<Cause>(s.cause)));
    }
    /// Of the computation whose operands are needed next, some may come from the stack with it.
    void allow_memory_operands(Hart& h) const { h.memory_operands = memory_operands_; }
    /// Of code that compilers take a sub-vector at a time.
    void end_stretch(Hart& h) const {
        if (by_register_) [[unlikely]]
            h.machine_registers->end_stretch();
    }
    std::uint32_t vector_instructions() const { return pieces_; }
    /// Whether caches are warmed by what threads touch, and nothing takes time (warming.cpp).
    bool warming() const { return warming_; }
    // ... of operations then (warm_path.cpp); `value`, `indices`, `mask`, `data`: vectors that are used
    stamp warm_scalar(Hart& h, std::size_t kind);
    stamp warm_operation(Hart& h, std::size_t kind, bool vector, std::uint32_t value);
    stamp warm_operation(Hart& h, std::size_t kind, bool vector, std::uint32_t value, std::uint32_t second);
    stamp warm_operation(Hart& h, std::size_t kind, bool vector, std::uint32_t value, std::uint32_t second,
                         std::uint32_t third);
    void warm_branch(Hart& h, site where, bool taken);
    stamp warm_load(Hart& h, site where, const void* p, std::uint32_t bytes, bool vector);
    stamp warm_load_vector(Hart& h, site where, const void* p, std::uint64_t lanes, std::uint32_t mask);
    stamp warm_gather(Hart& h, site where, const void* p, const std::int32_t* index, std::uint64_t lanes,
                      std::uint32_t indices, std::uint32_t mask);
    void warm_store(Hart& h, site where, const void* p, std::uint32_t bytes);
    void warm_store_vector(Hart& h, site where, const void* p, std::uint64_t lanes, std::uint32_t data,
                           std::uint32_t mask);
    void warm_scatter(Hart& h, site where, const void* p, const std::int32_t* index, std::uint64_t lanes,
                      std::uint32_t indices, std::uint32_t data, std::uint32_t mask);
    bool folds_addresses() const { return folding_; }
    bool shuffles_by_lane() const { return lane_shuffle_; }
    void assemble_shuffle(Hart& h, Due ready);
    stamp fold_address(Hart& h, Due ready);
    std::uint32_t span(std::size_t kind) const { return spans_[kind]; }
    std::uint32_t span(std::size_t kind, std::uint64_t lanes) const {
        return skip_idle_ ? span_of(kind, masked_instructions(lanes)) : spans_[kind];
    }

private:
    /// What the accesses of one operation bring together.
    struct Data {
        cycle first = ~cycle{0}, last = 0, granted = 0;
        Cause from = Cause::l1, held = Cause::mshrs; // what brought the last; what `granted` waited for
        std::uint32_t open = 0;                      // how many are not answered yet
        std::array<cycle, width> tickets;            // of these; not initialised
        Data() {}                                    // NOLINT: leaves `tickets` alone
    };
    static cycle follow(cycle first, cycle last, std::uint32_t span) {
        return std::max(first, last > span - 1 ? last - (span - 1) : 0);
    }
    /// A folded address: `first` says when its operands are there (a cycle or a ticket), `last` is its number
    /// below these bits.
    static constexpr cycle fold_bits = ticket_bit | ticket_bit >> 1U;
    static bool is_folded(const stamp& s) { return (s.last & fold_bits) == fold_bits; }
    // What follows takes `ready` and returns it later: by value, so that it stays in the host's registers.
    Due need_open(Hart& h, Due ready, const stamp& s, std::uint32_t span) {
        if (is_folded(s))
            return unfold(h, ready, s);
        h.pending[h.pending_count++] = {s.last, span, false};
        return ready;
    }
    void need_operands(Hart& h, Due& ready, const stamp& s) {
        if (is_ticket(s.first))
            h.pending[h.pending_count++] = {s.first, 0, false};
        else
            ready.later(Due(s.first, static_cast<Cause>(s.cause)));
    }
    Due unfold(Hart& h, Due ready, const stamp& s);
    [[gnu::always_inline]] void need_register(Hart& h, Due& ready, const stamp& s, std::uint32_t span) {
        if (s.value != 0) {
            const RegisterFile::Use where =
                by_register_ ? h.machine_registers->use(s.value) : h.registers.use(s.value);
            if (where != RegisterFile::Use::resident) [[unlikely]]
                ready = reload(h, ready, s.value, where == RegisterFile::Use::unstored, span);
        }
    }
    std::uint32_t make_value(Hart& h, bool broadcast) const {
        return by_register_ ? h.machine_registers->make(broadcast) : h.registers.make();
    }
    Due reload(Hart& h, Due ready, std::uint32_t value, bool unstored, std::uint32_t span);
    /// Waits until the times of all operands are known.
    void settle(Hart& h, Due& ready) {
        if (h.pending_count != 0) [[unlikely]]
            ready = await_operands(h, ready);
    }
    Due await_operands(Hart& h, Due ready);
    cycle await_room(Hart& h, cycle since, cycle until);
    void await_stores(Hart& h);
    void settle_loads(Hart& h);
    void settle_stores(Hart& h);

    /// For a thread that others have overtaken meanwhile, up to cycle `t`.
    void come_back(Hart& h, cycle t) const {
        if (t > reach_)
            h.bound.later(Due(t - reach_, Cause::slots));
    }
    cycle turn(Hart& h, cycle t);
    // --- nothing but caches (warming.cpp, warm_path.cpp)
    Issued pass(Hart& h, std::size_t kind, std::uint32_t instructions);
    void warm_line(Hart& h, std::uint64_t line, bool write, std::uint32_t accesses, std::uint32_t slots);
    void warm_other_line(Hart& h, std::uint64_t line, bool write, std::uint32_t accesses);
    template <class... Value> std::uint32_t warm_values(Hart& h, bool makes, bool broadcast, Value... values);
    template <class... Value> stamp warm_vectors(Hart& h, std::size_t kind, bool vector, Value... values);
    void warm_reload(Hart& h, std::uint32_t value, bool unstored);
    void warm_absent(Hart& h, const RegisterFile::Absent& absent);
    std::uint32_t warm_machine_registers(Hart& h, const std::uint32_t* values, std::size_t count, bool makes,
                                         bool broadcast);
    void warm_whole(Hart& h, std::uint64_t place, bool write);
    void warm_bytes(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write);
    void warm_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                      bool write);
    void warm_overhead(Hart& h);
    cycle passing(const Hart& h) const;
    void pause(Hart& h);
    void come_to(Hart& h) const;
    void begin_passing(Hart& h, bool writes, bool modifies, std::uint64_t address);
    void begin_warming();
    void end_warming();
    bool warm_window();
    bool run_sampled_window();
    void set_paces();
    void add_work(const Hart& h, SampledWork& done) const;
    WorkByCore work_so_far() const;
    cycle hold_core(Hart& h, cycle t);
    void account_issue(Hart& h, Issued at, std::uint32_t instructions, Due ready) const;
    cycle come_to_issue(Hart& h, Due ready);
    void note_issue(Hart& h, std::size_t kind, std::uint32_t instructions, Issued at, Due ready);
    Issued issue_here(Hart& h, std::size_t kind, std::uint32_t instructions, Due ready);
    Issued issue_here(Hart& h, std::size_t kind, Due ready);
    Issued issue(Hart& h, std::size_t kind, std::uint32_t instructions, Due ready);
    Issued issue(Hart& h, std::size_t kind, Due ready);
    Issued issue_all(Hart& h, std::size_t kind, std::uint32_t instructions, Due ready);
    Issued book(Core& core, std::size_t kind, std::uint32_t instructions, cycle t) const;
    Issued book_together(Core& core, std::size_t kind, std::uint32_t instructions, cycle t) const;
    void finish_issue(Hart& h, Issued at, cycle granted, Cause held = Cause::mshrs);
    void charge_overhead(Hart& h, std::uint32_t overhead, Due ready);
    void charge(Hart& h, std::uint32_t overhead, Due ready);
    void count(Hart& h, std::uint32_t instructions, bool vector);
    void touch(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write, cycle from, Data& data);
    void touch_line(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write, std::uint32_t accesses,
                    std::uint32_t slots, cycle& from, Data& data);
    template <std::uint32_t lines>
    bool touch_present(Hart& h, std::uint64_t line, bool write, std::uint32_t accesses, std::uint32_t slots,
                       cycle from, Data& data) const;
    /// The host's caches get what an access of that address will look at, while it is issued.
    void bring_line(Hart& h, std::uint64_t address) const {
        h.core->l1.bring_set(address >> line_shift_);
        h.tile->attribution.bring(address);
    }
    /// ... of the bytes [low, high] of a thread's stack.
    void bring_sets(Hart& h, std::uint64_t low, std::uint64_t high) const {
        for (std::uint64_t line = low >> line_shift_; line <= high >> line_shift_; ++line)
            h.core->l1.bring_set(line);
    }
    void read_spilled(Hart& h, std::uint64_t place, std::uint64_t lanes, cycle from, Data& data);
    void write_spilled(Hart& h, std::uint64_t place, std::uint64_t lanes, cycle from, Data& data);
    void touch_whole(Hart& h, std::uint64_t address, bool write, cycle from, Data& data);
    void note_touch(const Hart& h, std::uint64_t address, std::uint32_t bytes, bool write,
                    std::uint32_t accesses, cycle at, traces::Part part) const;
    traces::Part meet_site(Hart& h) const;
    void pass_site(Hart& h) const;
    /// For a trace: what has happened within the tile since the last reference.
    static std::uint32_t take_progress(const Hart& h, cycle at) {
        std::optional<TileEvents>& events = h.tile->events;
        return events ? TileProgress::of(events->take_count(), events->now(), at) : 0;
    }
    void note_refused(const Hart& h, std::uint64_t address, std::uint32_t bytes, Passing::Asks asks, cycle at,
                      traces::Part part) const;
    void note_core(Hart& h, traces::Kind kind, std::uint64_t address, std::uint32_t bytes, cycle at,
                   traces::Part part) const {
        if (recorder_ != nullptr && h.tile->tap->is_at(TraceLevel::core)) [[unlikely]]
            h.tile->attribution.note_always(kind, address, bytes, at, h.column, h.number, h.trace_site, part,
                                            take_progress(h, at));
    }
    void touch_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, bool write, cycle from, Data& data);
    void touch_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                       bool write, cycle from, Data& data);
    /// Bytes of a line, from `low` on, up to `high`.
    std::uint32_t bytes_in(std::uint64_t low, std::uint64_t high) const {
        return static_cast<std::uint32_t>(std::min(high, low | (line_bytes_ - 1)) - low) + 1;
    }
    std::uint32_t slots_of(std::uint32_t bytes) const {
        return (bytes + (1U << port_byte_shift_) - 1) >> port_byte_shift_;
    }
    /// Slots of a port that what lies of the bytes [low, high] in a line takes.
    std::uint32_t slots_in(std::uint64_t line, std::uint64_t low, std::uint64_t high) const {
        std::uint64_t first = std::max(low, line << line_shift_);
        std::uint64_t last = std::min(high, (line << line_shift_) + line_bytes_ - 1);
        return slots_of(static_cast<std::uint32_t>(last - first) + 1);
    }
    std::uint32_t span_of(std::size_t kind, std::uint32_t instructions) const;
    // --- lane by lane (lane_path.cpp)
    stamp load_indexed(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready);
    void store_indexed(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready);
    void assemble(Hart& h, std::uint32_t instructions, std::uint32_t references, Due ready);
    void touch_stack(Hart& h, std::uint32_t references, bool write, Due ready);
    void assemble_load(Hart& h, std::uint64_t lanes, Due ready);
    void assemble_store(Hart& h, std::uint64_t lanes, Due ready);

    std::uint32_t masked_instructions(std::uint64_t lanes) const;
    std::uint32_t indexed_instructions(std::uint64_t lanes, bool by_lane) const;
    cycle ticket_of(Hart& h, const Data& data) const;
    /// `broadcast`: the same for all lanes.
    stamp loaded(Hart& h, const Data& data, bool vector, bool broadcast = false);
    stamp loaded_ticket(Hart& h, const Data& data);
    void stored(Hart& h, const Data& data);
    // --- a store buffer (store_path.cpp)
    cycle drain_oldest(Hart& h);
    void buffer_store(Hart& h, std::uint64_t low, std::uint64_t high, bool whole, cycle& from, Data& all,
                      std::uint32_t slots = 0);
    void buffer_bytes(Hart& h, std::uint64_t address, std::uint32_t bytes, cycle from, Data& data);
    void buffer_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data);
    void buffer_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                        cycle from, Data& data);
    std::size_t buffered_at(Hart& h, std::uint64_t low, std::uint64_t high, cycle t);
    cycle drained(Hart& h, std::size_t entry);
    void load_around(Hart& h, std::uint64_t low, std::uint64_t high, cycle from, Data& data);
    bool meets_stores(Hart& h, std::uint64_t low, std::uint64_t high, cycle from);
    void load_bytes_around(Hart& h, std::uint64_t address, std::uint32_t bytes, cycle from, Data& data);
    void load_lanes_around(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data);
    cycle gather_after(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                       cycle from);
    void read_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data);
    void write_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data);

    // --- translation of addresses (translation.cpp)
    /// When the pages of the bytes [low, high] are translated for an operation that wants them from `from`
    /// on.
    cycle translated(Hart& h, std::uint64_t low, std::uint64_t high, cycle from) {
        return tlb_ ? translate(h, low, high, from) : from;
    }
    cycle translate(Hart& h, std::uint64_t low, std::uint64_t high, cycle from);
    cycle translate_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from);
    cycle translate_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                            cycle from);
    cycle translate_page(Hart& h, std::uint64_t page, cycle t);
    bool walk(Hart& h, std::uint64_t page, cycle& t);
    cycle read_tables(Hart& h, std::uint64_t page, cycle t);
    cycle await_walk(Hart& h, cycle t);
    static cycle wait_for_address(Hart& h, cycle from, cycle t, bool holds);
    /// Says of data that came without a ticket that they waited longer for their address than for themselves.
    void blame_translation(cycle from, cycle translated, Data& data) const {
        if (!holds_misses_ && translated > from && data.open == 0 &&
            translated - from >= data.last - translated)
            data.from = Cause::tlb;
    }
    bool may_prefetch(Hart& h, std::uint64_t address) const;

    /// Of the hart's core within its tile.
    std::size_t core_in_tile(const Hart& h) const {
        return h.number / wide(config_.chip.threads) % wide(config_.chip.cores);
    }
    Asker asker(const Hart& h) const { return {*h.tile, core_in_tile(h), h.column}; }
    cycle move_line(const Hart& h, std::uint64_t address, cycle t, cycle service);
    void publish(Hart& h, std::uint64_t address, cycle written, cycle done, bool chip);
    void check_visible(Hart& h, std::uint64_t address, cycle t, Due& ready);
    void pass_looks(Hart& sleeper) const;
    void look(Hart& sleeper, cycle end);
    void stop_looking(Hart& sleeper, cycle woken);
    std::uint64_t address(const void* p) const {
        auto a = static_cast<std::uint64_t>(static_cast<const std::byte*>(p) - base_);
        if (a >= lines_.spill_begin()) [[unlikely]]
            outside(p);
        return a;
    }
    void move_looks(const Hart& sleeper, cycle since, std::uint64_t looks);
    [[noreturn]] static void outside(const void* p);
    void enter(Hart& h, std::size_t column) const {
        if (options_.owners != nullptr || recorder_ != nullptr) [[unlikely]] {
            enter_for(h, column, h.party);
            return;
        }
        h.enter(column);
        if (!paces_.empty())
            h.pace = paces_[column];
    }
    void enter_for(Hart& h, std::size_t column, std::size_t party) const;
    void charge_owners(Hart& h) const;
    void begin_owners();
    void finish_owners(Report& r);
    static void check_label(const char* what, std::size_t number, std::size_t count);

    void describe_kinds();
    std::vector<traces::Description::Region> regions() const;
    void trace();
    // --- windows
    void note_window(cycle next, cycle served);
    bool run_window();
    void forget_before(cycle begin);
    void end_window();
    void find_active_tiles();
    cycle next_event() const;
    void set_floors(cycle arrival);
    void run_tiles();
    void run_tile(Tile& tile);
    void run_shared(std::size_t number, std::size_t threads);
    void perform_deeds();
    void resume(Hart& h, cycle t);
    void answer_parked(Tile& tile, cycle t, const std::function<bool(const Hart&)>& has_room);
    void follow_events(Tile& tile);
    void settle_tiles();
    void serve_window();
    void shuffle();
    void forget_tickets(Tile& tile);
    void fail(const std::exception_ptr& why);
    void run_workers();
    void begin_part(cycle t);
    void begin_counting();
    void serve_all();
    void finish_part();
    void judge_prefetches();
    void finish_frame();
    std::string describe_deadlock() const;
    Interval sums() const;
    Report report() const;
    void add_intervals(Report& r);

    // --- constants of the machine, in the types that the hot paths want
    Config config_;
    bool warming_ = false;      // see warming.cpp
    std::uint32_t pieces_;      // machine instructions of a vector operation
    std::uint32_t piece_lanes_; // logical lanes of one of them, a power of two
    unsigned piece_shift_;      // of their bytes
    unsigned issue_shift_, port_shift_;
    /// Between two looks of a waiting thread: those of all take turns, so that others get their part of the
    /// slots.
    std::uint64_t spin_cycles_;
    std::uint32_t issue_width_, line_bytes_;
    std::uint32_t whole_lines_; // that all lanes take, where they are one or two whole lines; else 0
    unsigned line_shift_, port_byte_shift_;
    std::uint64_t l1_latency_;
    unsigned tile_levels_, cache_levels_; // of caches: within a tile, in all
    // by kind of instruction (pairing.h)
    std::array<std::uint32_t, issue_kinds> latency_{}, interval_{};
    std::array<std::uint32_t, issue_kinds> takes_{}; // instructions of a sub-vector
    std::array<std::uint32_t, issue_kinds>
        spans_{}; // cycles in which a vector operation can issue at the least
    enum class Needs : std::uint8_t { slot, own_unit, several };
    std::array<Needs, issue_kinds> needs_{};
    std::array<bool, issue_kinds> shared_{};
    Pairing pairing_;
    std::uint32_t overhead_, scalar_moves_, vector_moves_; // 1/1024 instructions
    std::uint32_t memory_operands_;
    bool registers_, by_register_, strides_, notes_sites_, notes_accesses_, lane_gather_, lane_scatter_,
        lane_shuffle_, skip_idle_, folding_, buffered_;
    bool masked_by_lane_, idle_lanes_;
    struct LanePath { // config's, narrowed
        std::uint32_t piece_instructions, piece_references, gather_instructions;
        std::uint32_t load_instructions, load_references, store_instructions, store_references;
    } lane_path_;
    bool hold_policy_;
    bool tlb_, holds_misses_; // tlb.misses
    unsigned page_shift_;
    Recorder* recorder_; // or null
    bool in_order_;      // operations act when they are ready, not when the issue window reaches them
    enum class Prediction { counters, taken, not_taken, none, perfect } prediction_;

    const std::byte* base_;
    std::uint64_t window_cycles_;                   // of the windows in which tiles run by themselves
    std::uint64_t shortest_answer_, shortest_line_; // of what lies beyond a tile
    std::uint64_t reach_; // cycles that an operation may lie behind its thread's latest turn
    const isa::address_space& space_;
    Labels labels_;                    // the caller's, and the end of the frame
    std::optional<PageTables> tables_; // that walks read
    LineMap lines_;
    Homes homes_;
    Published published_; // words that several tiles reach
    WordMoves moves_;     // of their lines
    std::unique_ptr<Beyond> beyond_;
    std::deque<Tile> tiles_;
    std::vector<Tile*> order_;  // in which the host takes them
    std::vector<Tile*> active_; // of these
    std::mt19937 shuffled_;
    std::deque<Hart> harts_;
    HostThreads host_threads_;
    cycle window_end_ = 0;
    std::exception_ptr failure_;
    cycle cycles_ = 0; // of the whole run
    RunOptions options_;
    std::function<void(int)> worker_;
    Intervals intervals_;
    Interval at_end_;                                     // of the run: what has been counted
    std::optional<Sampler> sampler_;                      // if the run is sampled
    std::array<std::uint64_t, cause_count> miss_paces_{}; // 1/256 cycles, by where a line came from
    std::uint64_t word_pace_ = 0;                         // ... of an operation on a shared word
    std::vector<std::uint32_t> paces_;                    // ... of an instruction, by column
    std::uint64_t misplaced_lines_ = 0, incoherent_lines_ = 0;
    int workers_;
};

/// The run and the hardware thread that the port acts for; null outside a run. Threads of a tile that let
/// others run may go on on another thread of the host. As compilers may keep the address of what is
/// thread_local over a call, no function looks at `running_hart` again after it has called what does so.
extern Engine* running_engine;
extern constinit thread_local Hart* running_hart;
/// Sets it; a call, whose own look at its address is fresh.
[[gnu::noinline]] void come_back_as(Hart* h);

/// While a thread lets others run: whoever comes back is the one that left, also when it is being unwound.
class Away {
public:
    explicit Away(Hart& self) : self_(self) {}
    Away(const Away&) = delete;
    Away& operator=(const Away&) = delete;
    ~Away() { come_back_as(&self_); }

private:
    Hart& self_;
};

} // namespace sim
