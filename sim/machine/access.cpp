// Loads, stores and hints, and the timing port's functions for them (isa/simulated/port.h).
#include "sim/machine/asides.h"
#include "sim/machine/issue.h"

#include <bit>

namespace sim {

/// Lanes one after the other.
constexpr std::array<std::int32_t, width> in_order = [] {
    std::array<std::int32_t, width> out{};
    for (std::uint32_t i = 0; i < width; ++i)
        out[i] = static_cast<std::int32_t>(i);
    return out;
}();

// --- which lines an operation touches

/// For a trace: accesses of one line share its bytes evenly.
void Engine::note_touch(const Hart& h, std::uint64_t address, std::uint32_t bytes, bool write,
                        std::uint32_t accesses, cycle at, traces::Part part) const {
    if (!h.tile->tap->is_at(TraceLevel::core))
        return;
    const std::uint32_t step = accesses == 1 ? 0 : bytes / accesses / 4 * 4;
    std::uint32_t progress = take_progress(h, at);
    for (std::uint32_t i = 0; i < accesses; ++i) {
        const traces::Part which = i == 0 ? part : traces::Part::piece;
        const std::uint32_t rest = bytes - i * step;
        h.tile->attribution.note_always(write ? traces::Kind::write : traces::Kind::read, address + i * step,
                                        step == 0 || i + 1 == accesses ? rest : step, at, h.column, h.number,
                                        h.trace_site, which, progress);
        progress = take_progress(h, at);
    }
}

/// ... and what an L1 had no room for, though lines below have moved for it.
void Engine::note_refused(const Hart& h, std::uint64_t address, std::uint32_t bytes, Passing::Asks asks,
                          cycle at, traces::Part part) const {
    if (recorder_ != nullptr && h.tile->tap->is_at(TraceLevel::core))
        h.tile->attribution.note_always(
            traces::Kind::refused, address, bytes, at, h.column, h.number, h.trace_site,
            part == traces::Part::aside ? part : traces::Part::access, Passing::of(asks));
}

/// One machine access; across lines, one of each.
inline void Engine::touch(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write, cycle from,
                          Data& data) {
    std::uint64_t high = address + bytes - 1;
    if (address >> line_shift_ == high >> line_shift_) [[likely]] {
        const std::uint32_t slots = slots_of(bytes);
        if (!touch_present<1>(h, address >> line_shift_, write, 1, slots, from, data))
            touch_line(h, address, bytes, write, 1, slots, from, data);
        return;
    }
    for (std::uint64_t line = address >> line_shift_; line <= high >> line_shift_; ++line) {
        const std::uint64_t low = std::max(address, line << line_shift_);
        touch_line(h, low, bytes_in(low, high), write, 1, slots_in(line, address, high), from, data);
    }
}

/// All lanes, of pieces within a line each.
void Engine::touch_whole(Hart& h, std::uint64_t address, bool write, cycle from, Data& data) {
    const std::uint32_t slots = slots_of(piece_lanes_ * 4);
    if (whole_lines_ != 0 && (address & (line_bytes_ - 1)) == 0) {
        const std::uint32_t pieces = line_bytes_ >> piece_shift_;
        const std::uint64_t line = address >> line_shift_;
        if (whole_lines_ == 2 ? touch_present<2>(h, line, write, pieces, pieces * slots, from, data)
                              : touch_present<1>(h, line, write, pieces, pieces * slots, from, data))
            return;
    }
    const std::uint64_t end = address + width * 4;
    while (address < end) {
        const std::uint64_t next = std::min(end, (address | (line_bytes_ - 1)) + 1);
        const auto pieces = static_cast<std::uint32_t>(next - address) >> piece_shift_;
        touch_line(h, address, static_cast<std::uint32_t>(next - address), write, pieces, pieces * slots,
                   from, data);
        address = next;
    }
}

/// Consecutive lanes: an access for each machine instruction with a lane that is on, and each line it
/// touches.
void Engine::touch_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, bool write, cycle from,
                         Data& data) {
    const std::uint32_t bytes = piece_lanes_ * 4;
    if (lanes == all_lanes && (address & (bytes - 1)) == 0 && bytes <= line_bytes_) [[likely]] {
        touch_whole(h, address, write, from, data);
        return;
    }
    std::uint64_t piece_mask = ~std::uint64_t{0} >> (64 - piece_lanes_);
    std::uint64_t run_line = 0, run_low = 0, run_high = 0;
    std::uint32_t run = 0, run_slots = 0;
    const auto touch_run = [&] {
        touch_line(h, run_low, bytes_in(run_low, run_high), write, run, run_slots, from, data);
    };
    for (std::uint32_t i = 0; i < pieces_; ++i) {
        std::uint64_t on = lanes >> (i * piece_lanes_) & piece_mask;
        if (on == 0)
            continue;
        std::uint64_t piece = address + i * bytes;
        std::uint64_t low = piece + 4 * static_cast<unsigned>(std::countr_zero(on));
        std::uint64_t high = piece + 4 * static_cast<unsigned>(63 - std::countl_zero(on)) + 3;
        for (std::uint64_t line = low >> line_shift_; line <= high >> line_shift_; ++line) {
            if (run != 0 && line != run_line) {
                touch_run();
                run = run_slots = 0;
            }
            if (run == 0)
                run_low = std::max(low, line << line_shift_);
            run_line = line;
            run_high = high;
            ++run;
            run_slots += slots_in(line, low, high);
        }
    }
    if (run != 0)
        touch_run();
}

inline void Engine::read_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data) {
    if (buffered_ && meets_stores(h, address, address + width * 4 - 1, from)) [[unlikely]]
        load_lanes_around(h, address, lanes, from, data);
    else
        touch_lanes(h, address, lanes, false, from, data);
}
inline void Engine::write_lanes(Hart& h, std::uint64_t address, std::uint64_t lanes, cycle from, Data& data) {
    if (buffered_) [[unlikely]]
        buffer_lanes(h, address, lanes, from, data);
    else
        touch_lanes(h, address, lanes, true, from, data);
}
/// A place of a whole value on the stack, which lies as lines do.
inline void Engine::read_spilled(Hart& h, std::uint64_t place, std::uint64_t lanes, cycle from, Data& data) {
    if (lanes == all_lanes && whole_lines_ != 0 && !buffered_) [[likely]]
        touch_whole(h, place, false, from, data);
    else
        read_lanes(h, place, lanes, from, data);
}
inline void Engine::write_spilled(Hart& h, std::uint64_t place, std::uint64_t lanes, cycle from, Data& data) {
    if (lanes == all_lanes && whole_lines_ != 0 && !buffered_) [[likely]]
        touch_whole(h, place, true, from, data);
    else
        write_lanes(h, place, lanes, from, data);
}

/// Lanes anywhere: for each machine instruction every distinct line once, or (core.gather = "lane") every
/// lane.
void Engine::touch_indexed(Hart& h, std::uint64_t address, const std::int32_t* index, std::uint64_t lanes,
                           bool write, cycle from, Data& data) {
    const bool by_lane = write ? lane_scatter_ : lane_gather_;
    auto address_of = [&](std::uint32_t lane) {
        return address + static_cast<std::uint64_t>(std::int64_t{index[lane]} * 4);
    };
    std::array<std::uint64_t, width> accessed, lines; // NOLINT: filled as far as used
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < width; i += piece_lanes_) {
        const std::uint32_t begin = count;
        for (std::uint32_t lane = i; lane < i + piece_lanes_; ++lane) {
            if ((lanes >> lane & 1U) == 0)
                continue;
            const std::uint64_t at = address_of(lane), line = at >> line_shift_;
            auto* end = lines.begin() + count;
            if (by_lane || std::find(lines.begin() + begin, end, line) == end) {
                accessed[count] = at;
                lines[count++] = line;
            }
        }
    }
    for (std::uint32_t k = 0; k < count;) {
        std::uint32_t same = k + 1; // those of one line, one after the other
        while (same < count && lines[same] == lines[k])
            ++same;
        const std::uint32_t run = same - k;
        if (touch_present<1>(h, lines[k], write, run, run, from, data)) {
            k = same;
            continue;
        }
        for (; k < same; ++k)
            touch_line(h, accessed[k], 4, write, 1, 1, from, data);
    }
}

std::uint32_t Engine::masked_instructions(std::uint64_t lanes) const {
    if (!skip_idle_)
        return pieces_;
    std::uint64_t piece_mask = ~std::uint64_t{0} >> (64 - piece_lanes_);
    std::uint32_t active = 0;
    for (std::uint32_t i = 0; i < width; i += piece_lanes_)
        active += (lanes >> i & piece_mask) != 0 ? 1 : 0;
    return std::max(1U, active);
}

std::uint32_t Engine::indexed_instructions(std::uint64_t lanes, bool by_lane) const {
    return by_lane ? std::max(1U, static_cast<std::uint32_t>(std::popcount(lanes)))
                   : masked_instructions(lanes);
}

// --- what becomes of it

/// One ticket for all of an operation's open accesses and what is known of the others.
cycle Engine::ticket_of(Hart& h, const Data& data) const {
    if (data.open == 1 && data.last == 0)
        return data.tickets[0];
    return h.tile->tickets.join({data.first, data.last, data.from}, data.tickets.data(), data.open);
}

/// The stamp of a load that is not answered yet.
stamp Engine::loaded_ticket(Hart& h, const Data& data) {
    stamp r;
    r.first = r.last = ticket_of(h, data);
    if (h.loading.size() >= 32)
        settle_loads(h);
    h.loading.push_back(r.last);
    return r;
}

void Engine::stored(Hart& h, const Data& data) {
    if (warming_) [[unlikely]]
        return;
    h.stored = std::max(h.stored, data.last);
    h.complete.later(Due(data.last, data.from));
    if (data.open == 0) [[likely]]
        return;
    if (h.storing.size() >= 32)
        settle_stores(h);
    h.storing.insert(h.storing.end(), data.tickets.begin(), data.tickets.begin() + data.open);
}

/// Rule 3: a register that was not kept comes back through the L1, stored first if it never was. An operand
/// that the operation at hand takes from memory is loaded without an instruction, issue slot or port: by the
/// L1's ports alone.
Due Engine::reload(Hart& h, Due ready, std::uint32_t value, bool unstored, std::uint32_t span) {
    const bool broadcast = by_register_ && MachineRegisters::is_broadcast(value);
    const std::uint32_t pieces = broadcast ? 1 : pieces_;
    const std::uint32_t number = by_register_ ? MachineRegisters::number(value) : value;
    const std::uint64_t lanes = broadcast ? ~std::uint64_t{0} >> (64 - piece_lanes_) : all_lanes;
    const std::uint64_t place = h.spill_base + number % wide(config_.core.spill_slots) * (width * 4);
    const std::uint64_t last = place + pieces * piece_lanes_ * 4 - 1;
    bring_sets(h, place, last);
    Due now = begin(h);
    h.site = {};
    h.trace_site = 0;
    if (unstored) {
        ++h.counters.spill_stores;
        Issued at = issue(h, vector_kind(store_kind), pieces, now);
        Data data;
        write_spilled(h, place, lanes, translated(h, place, last, at.first), data);
        if (data.held == Cause::stores) [[unlikely]]
            h.bound.later(Due(data.granted, data.held));
        stored(h, data);
    }
    ++h.counters.spill_loads;
    cycle from;
    if (h.memory_operands != 0) {
        --h.memory_operands;
        ++h.counters.memory_operands;
        from = come_to_issue(h, now);
    } else {
        from = issue(h, vector_kind(load_kind), pieces, now).first;
    }
    Data data;
    read_spilled(h, place, lanes, translated(h, place, last, from), data);
    if (warming_) [[unlikely]] // since this began: nothing brought a time
        return ready;
    if (data.open != 0)
        h.pending[h.pending_count++] = {ticket_of(h, data), span, true};
    else
        ready.later(Due(follow(data.first, data.last, span), Cause::spill));
    return ready;
}

stamp Engine::load(Hart& h, const void* p, std::uint32_t bytes, Due ready, bool vector) {
    const std::uint64_t a = address(p);
    bring_line(h, a);
    charge_overhead(h, overhead_, begin(h));
    settle(h, ready);
    Issued at = issue_here(h, load_kind, ready);
    Data data;
    const cycle from = translated(h, a, a + bytes - 1, at.first);
    if (buffered_ && meets_stores(h, a, a + bytes - 1, from)) [[unlikely]]
        load_bytes_around(h, a, bytes, from, data);
    else
        touch(h, a, bytes, false, from, data);
    blame_translation(at.first, from, data);
    finish_issue(h, at, data.granted);
    count(h, 1, vector);
    ++h.counters.loads;
    return loaded(h, data, vector, vector);
}

stamp Engine::load_vector(Hart& h, const void* p, std::uint64_t lanes, bool masked, Due ready) {
    if (lanes != 0)
        bring_line(h, address(p));
    charge_overhead(h, overhead_, begin(h));
    settle(h, ready);
    if (masked && masked_by_lane_) [[unlikely]]
        return load_indexed(h, p, in_order.data(), lanes, ready);
    std::uint32_t instructions = masked_instructions(lanes);
    Issued at = issue(h, vector_kind(load_kind), instructions, ready);
    Data data;
    if (lanes == 0) {
        data.first = data.last = at.last + l1_latency_;
    } else {
        const std::uint64_t a = address(p);
        const cycle from = tlb_ ? translate_lanes(h, a, lanes, at.first) : at.first;
        read_lanes(h, a, lanes, from, data);
        blame_translation(at.first, from, data);
    }
    finish_issue(h, at, data.granted);
    count(h, instructions, true);
    ++h.counters.loads;
    return loaded(h, data, true);
}

stamp Engine::gather(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready) {
    charge_overhead(h, overhead_, begin(h));
    settle(h, ready);
    ++h.counters.gathers;
    return load_indexed(h, p, index, lanes, ready);
}

stamp Engine::load_indexed(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes,
                           Due ready) {
    assemble_load(h, lanes, ready);
    std::uint32_t instructions = indexed_instructions(lanes, lane_gather_);
    Issued at = issue(h, vector_kind(load_kind), instructions, ready);
    Data data;
    if (lanes == 0) {
        data.first = data.last = at.last + l1_latency_;
    } else {
        const std::uint64_t a = address(p);
        const cycle from = tlb_ ? translate_indexed(h, a, index, lanes, at.first) : at.first;
        touch_indexed(h, a, index, lanes, false, buffered_ ? gather_after(h, a, index, lanes, from) : from,
                      data);
        blame_translation(at.first, from, data);
    }
    finish_issue(h, at, data.granted);
    count(h, instructions, true);
    ++h.counters.loads;
    return loaded(h, data, true);
}

void Engine::store(Hart& h, const void* p, std::uint32_t bytes, Due ready) {
    const std::uint64_t a = address(p);
    bring_line(h, a);
    settle(h, ready);
    Issued at = issue(h, store_kind, ready);
    Data data;
    const cycle from = translated(h, a, a + bytes - 1, at.first);
    if (buffered_) [[unlikely]]
        buffer_bytes(h, a, bytes, from, data);
    else
        touch(h, a, bytes, true, from, data);
    finish_issue(h, at, data.granted, data.held);
    count(h, 1, false);
    ++h.counters.stores;
    stored(h, data);
}

void Engine::store_vector(Hart& h, const void* p, std::uint64_t lanes, bool masked, Due ready) {
    if (lanes != 0)
        bring_line(h, address(p));
    settle(h, ready);
    if (masked && masked_by_lane_) [[unlikely]]
        return store_indexed(h, p, in_order.data(), lanes, ready);
    std::uint32_t instructions = masked_instructions(lanes);
    Issued at = issue(h, vector_kind(store_kind), instructions, ready);
    Data data;
    if (lanes != 0) {
        const std::uint64_t a = address(p);
        write_lanes(h, a, lanes, tlb_ ? translate_lanes(h, a, lanes, at.first) : at.first, data);
    }
    finish_issue(h, at, data.granted, data.held);
    count(h, instructions, true);
    ++h.counters.stores;
    stored(h, data);
}

void Engine::scatter(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes, Due ready) {
    settle(h, ready);
    ++h.counters.scatters;
    store_indexed(h, p, index, lanes, ready);
}

void Engine::store_indexed(Hart& h, const void* p, const std::int32_t* index, std::uint64_t lanes,
                           Due ready) {
    if (lane_scatter_)
        assemble_store(h, lanes, ready);
    std::uint32_t instructions = indexed_instructions(lanes, lane_scatter_);
    Issued at = issue(h, vector_kind(store_kind), instructions, ready);
    Data data;
    const std::uint64_t a = address(p);
    const cycle from = tlb_ && lanes != 0 ? translate_indexed(h, a, index, lanes, at.first) : at.first;
    if (buffered_) [[unlikely]]
        buffer_indexed(h, a, index, lanes, from, data);
    else if (lanes != 0)
        touch_indexed(h, a, index, lanes, true, from, data);
    finish_issue(h, at, data.granted, data.held);
    count(h, instructions, true);
    ++h.counters.stores;
    stored(h, data);
}

void Engine::prefetch(Hart& h, const void* p, Due ready) {
    settle(h, ready);
    Issued at = issue(h, load_kind, ready);
    if (may_prefetch(h, address(p))) {
        cycle t = warming_ ? h.now : h.core->ports.take(at.first << port_shift_) >> port_shift_;
        ++h.core->l1.counters().busy_cycles;
        note_core(h, traces::Kind::prefetch, address(p), line_bytes_, t, traces::Part::operation);
        if (recorder_ != nullptr)
            h.tile->tap->site = h.trace_site;
        h.tile->site = {}; // prefetchers learn from accesses alone
        h.core->l1.prefetch(address(p), t, h.column);
    }
    finish_issue(h, at, 0);
    count(h, 1, false);
}

/// Whole lines only; an instruction each.
void Engine::discard(Hart& h, const void* p, std::uint32_t bytes, Due ready) {
    settle(h, ready);
    std::uint64_t begin = address(p);
    std::uint64_t end = begin + bytes;
    std::uint64_t first = (begin + line_bytes_ - 1) >> line_shift_;
    std::uint64_t last = end >> line_shift_;
    std::uint32_t lines = last > first ? static_cast<std::uint32_t>(last - first) : 0;
    Issued at = issue(h, store_kind, std::max(1U, lines), ready);
    for (std::uint64_t line = first; line < last; ++line) {
        note_core(h, traces::Kind::flush, line << line_shift_, line_bytes_, at.first,
                  line == first ? traces::Part::operation : traces::Part::access);
        h.core->l1.discard(line << line_shift_);
        discard_below(config_, asker(h), line << line_shift_, begin, end, at.first);
    }
    finish_issue(h, at, 0);
    count(h, 1, false);
}

} // namespace sim

namespace isa::timing {
namespace {

/// The running thread's next operation, as its operands become known.
struct Next {
    sim::Engine& engine = *sim::running_engine;
    sim::Hart& hart = *sim::running_hart;
    sim::Due ready = engine.begin(hart);

    Next& address(const stamp& s) {
        engine.need_address(hart, ready, s);
        return *this;
    }
    Next& scalar(const stamp& s) {
        engine.need_scalar(hart, ready, s);
        return *this;
    }
    Next& lanes(const stamp& s, std::uint32_t span) {
        engine.need_lanes(hart, ready, s, span, engine.in_registers(hart, s));
        return *this;
    }
};
constexpr std::size_t vector_load = sim::vector_kind(sim::load_kind);
constexpr std::size_t vector_store = sim::vector_kind(sim::store_kind);

} // namespace

stamp load(site where, const void* p, std::uint32_t bytes, const stamp& address) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_load(*sim::running_hart, where, p, bytes, false);
    Next n;
    n.address(address);
    n.engine.note_site(n.hart, where);
    return n.engine.load(n.hart, p, bytes, n.ready, false);
}
stamp load_broadcast(site where, const void* p, std::uint32_t bytes, const stamp& address) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_load(*sim::running_hart, where, p, bytes, true);
    Next n;
    n.address(address);
    n.engine.note_site(n.hart, where);
    return n.engine.load(n.hart, p, bytes, n.ready, true);
}
stamp load_vector(site where, const void* p, std::uint64_t lanes, const stamp& address, const stamp& mask) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_load_vector(*sim::running_hart, where, p, lanes, mask.value);
    Next n;
    std::uint32_t span = n.engine.span(vector_load, lanes);
    n.address(address).lanes(mask, span);
    n.engine.note_site(n.hart, where);
    return n.engine.load_vector(n.hart, p, lanes, mask.value != 0, n.ready);
}
stamp gather(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& mask) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_gather(*sim::running_hart, where, p, index, lanes, indices.value,
                                                mask.value);
    Next n;
    std::uint32_t span = n.engine.span(vector_load, lanes);
    n.address(address).lanes(indices, span).lanes(mask, span);
    n.engine.note_site(n.hart, where);
    return n.engine.gather(n.hart, p, index, lanes, n.ready);
}
void store(site where, const void* p, std::uint32_t bytes, const stamp& address, const stamp& data) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_store(*sim::running_hart, where, p, bytes);
    Next n;
    n.address(address).scalar(data);
    n.engine.note_site(n.hart, where);
    n.engine.store(n.hart, p, bytes, n.ready);
}
void store_vector(site where, const void* p, std::uint64_t lanes, const stamp& address, const stamp& data,
                  const stamp& mask) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_store_vector(*sim::running_hart, where, p, lanes, data.value,
                                                      mask.value);
    Next n;
    std::uint32_t span = n.engine.span(vector_store, lanes);
    n.address(address).lanes(data, span).lanes(mask, span);
    n.engine.note_site(n.hart, where);
    n.engine.store_vector(n.hart, p, lanes, mask.value != 0, n.ready);
}
void scatter(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& data, const stamp& mask) {
    if (sim::running_engine->warming()) [[unlikely]]
        return sim::running_engine->warm_scatter(*sim::running_hart, where, p, index, lanes, indices.value,
                                                 data.value, mask.value);
    Next n;
    std::uint32_t span = n.engine.span(vector_store, lanes);
    n.address(address).lanes(indices, span).lanes(data, span).lanes(mask, span);
    n.engine.note_site(n.hart, where);
    n.engine.scatter(n.hart, p, index, lanes, n.ready);
}
void prefetch(site where, const void* p, const stamp& address) {
    Next n;
    n.address(address);
    n.engine.note_trace_site(n.hart, where);
    n.engine.prefetch(n.hart, p, n.ready);
}
void discard(site where, const void* p, std::uint32_t bytes, const stamp& address) {
    Next n;
    n.address(address);
    n.engine.note_trace_site(n.hart, where);
    n.engine.discard(n.hart, p, bytes, n.ready);
}

} // namespace isa::timing
