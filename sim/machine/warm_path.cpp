// What operations do while caches are only warmed (warming.cpp): each is counted, takes what the sampler says
// of its kind of work, uses registers and touches lines, in the order in which it would in detail. Results
// have stamps of constants, but for the register that a vector is in. What few machines have (lanes one by
// one) goes the detailed way, whose parts know that nothing takes time.
#include "sim/machine/issue.h"

#include <bit>

namespace sim {
namespace {

constexpr std::size_t vector_load = vector_kind(load_kind), vector_store = vector_kind(store_kind);
constexpr std::size_t extract_kind = vector_kind(static_cast<std::size_t>(operation::shuffle));
constexpr std::size_t broadcast_kind = vector_kind(static_cast<std::size_t>(operation::broadcast));

} // namespace

/// A line that is not there, or of a cache that does more than the least.
[[gnu::noinline]] void Engine::warm_other_line(Hart& h, std::uint64_t line, bool write,
                                               std::uint32_t accesses) {
    if (notes_sites_)
        meet_site(h);
    const Cause from = h.core->l1.access(line, write, accesses, h.now, h.column).from;
    if (from != Cause::l1)
        h.ahead -= static_cast<std::int64_t>(miss_paces_[static_cast<std::size_t>(from)]);
    if (notes_sites_)
        pass_site(h);
}

inline void Engine::warm_bytes(Hart& h, std::uint64_t address, std::uint32_t bytes, bool write) {
    const std::uint64_t high = address + bytes - 1;
    if (address >> line_shift_ == high >> line_shift_) [[likely]] {
        warm_line(h, address >> line_shift_, write, 1, slots_of(bytes));
        return;
    }
    for (std::uint64_t line = address >> line_shift_; line <= high >> line_shift_; ++line)
        warm_line(h, line, write, 1, slots_in(line, address, high));
}

/// All lanes, at a place that begins a line where they are whole lines.
inline void Engine::warm_whole(Hart& h, std::uint64_t place, bool write) {
    if (whole_lines_ == 0 || (place & (line_bytes_ - 1)) != 0) [[unlikely]] {
        Data data;
        touch_lanes(h, place, all_lanes, write, h.now, data);
        return;
    }
    const std::uint32_t pieces = line_bytes_ >> piece_shift_, slots = pieces * slots_of(piece_lanes_ * 4);
    const std::uint64_t line = place >> line_shift_;
    warm_line(h, line, write, pieces, slots);
    if (whole_lines_ == 2)
        warm_line(h, line + 1, write, pieces, slots);
}

/// Lane after lane; those of one line that follow each other go together where it is there.
inline void Engine::warm_indexed(Hart& h, std::uint64_t address, const std::int32_t* index,
                                 std::uint64_t lanes, bool write) {
    if (notes_sites_ || !(write ? lane_scatter_ : lane_gather_)) {
        Data data;
        touch_indexed(h, address, index, lanes, write, h.now, data);
        return;
    }
    const auto line_of = [&](std::uint64_t left) {
        return (address + static_cast<std::uint64_t>(std::int64_t{index[std::countr_zero(left)]} * 4)) >>
               line_shift_;
    };
    Cache& l1 = h.core->l1;
    while (lanes != 0) {
        const std::uint64_t line = line_of(lanes);
        std::uint32_t run = 1;
        for (lanes &= lanes - 1; lanes != 0 && line_of(lanes) == line; lanes &= lanes - 1)
            ++run;
        l1.counters().busy_cycles += run;
        std::array<CacheArray::Place, 1> place; // NOLINT: filled where it is used
        if (l1.find_present(line, place)) [[likely]]
            l1.use_present(line, place, write, run, h.column);
        else
            while (run-- != 0)
                warm_other_line(h, line, write, 1);
    }
}

inline void Engine::warm_overhead(Hart& h) {
    if (overhead_ == 0)
        return;
    h.overhead += overhead_;
    const std::uint32_t whole = h.overhead / 1024;
    h.overhead %= 1024;
    if (whole != 0) {
        h.counters.overhead_instructions += whole;
        pass(h, integer_kind, whole);
    }
}

/// As reload(), of which this is all that does not take time.
inline void Engine::warm_reload(Hart& h, std::uint32_t value, bool unstored) {
    const bool broadcast = by_register_ && MachineRegisters::is_broadcast(value);
    const std::uint32_t pieces = broadcast ? 1 : pieces_;
    const std::uint32_t number = by_register_ ? MachineRegisters::number(value) : value;
    const std::uint64_t place = h.spill_base + number % wide(config_.core.spill_slots) * (width * 4);
    const std::uint64_t last = place + pieces * piece_lanes_ * 4 - 1;
    const auto touch = [&](bool write) {
        translated(h, place, last, h.now);
        if (!broadcast) {
            warm_whole(h, place, write);
        } else {
            Data data;
            touch_lanes(h, place, ~std::uint64_t{0} >> (64 - piece_lanes_), write, h.now, data);
        }
    };
    h.site = {};
    h.trace_site = 0;
    if (unstored) {
        ++h.counters.spill_stores;
        pass(h, vector_store, pieces);
        touch(true);
    }
    ++h.counters.spill_loads;
    if (h.memory_operands != 0) {
        --h.memory_operands;
        ++h.counters.memory_operands;
    } else {
        pass(h, vector_load, pieces);
    }
    touch(false);
}

[[gnu::noinline]] void Engine::warm_absent(Hart& h, const RegisterFile::Absent& absent) {
    for (std::uint32_t i = 0; i < absent.count; ++i)
        warm_reload(h, absent.values[i],
                    h.registers.store_once(absent.values[i]) == RegisterFile::Use::unstored);
}

/// Vectors are used one after the other; returns the number of a new one, if that is wanted.
template <class... Value>
[[gnu::always_inline]] inline std::uint32_t Engine::warm_values(Hart& h, bool makes, bool broadcast,
                                                                Value... values) {
    if (!by_register_) [[likely]] {
        RegisterFile::Absent absent;
        const std::uint32_t made = h.registers.use_and_make(makes, absent, values...);
        if (absent.count != 0)
            warm_absent(h, absent);
        return made;
    }
    const std::array<std::uint32_t, sizeof...(values)> all{values...};
    return warm_machine_registers(h, all.data(), all.size(), makes, broadcast);
}

[[gnu::noinline]] std::uint32_t Engine::warm_machine_registers(Hart& h, const std::uint32_t* values,
                                                               std::size_t count, bool makes,
                                                               bool broadcast) {
    for (std::size_t i = 0; i < count; ++i)
        if (values[i] != 0)
            if (const auto where = h.machine_registers->use(values[i]); where != RegisterFile::Use::resident)
                warm_reload(h, values[i], where == RegisterFile::Use::unstored);
    return makes ? h.machine_registers->make(broadcast) : 0;
}

template <class... Value>
[[gnu::always_inline]] inline stamp Engine::warm_vectors(Hart& h, std::size_t kind, bool vector,
                                                         Value... values) {
    const bool broadcast = kind == broadcast_kind;
    const std::uint32_t instructions = broadcast ? 1 : pieces_;
    const std::uint32_t taken = !vector && kind == extract_kind ? instructions : instructions * takes_[kind];
    h.memory_operands = memory_operands_;
    pass(h, kind, taken);
    count(h, instructions, vector || instructions > 1);
    if (vector_moves_ != 0) [[unlikely]]
        charge(h, vector_moves_ * taken, {});
    stamp r;
    r.value = warm_values(h, vector, broadcast, values...);
    h.memory_operands = 0;
    return r;
}

stamp Engine::warm_operation(Hart& h, std::size_t kind, bool vector, std::uint32_t value) {
    return warm_vectors(h, kind, vector, value);
}
stamp Engine::warm_operation(Hart& h, std::size_t kind, bool vector, std::uint32_t value,
                             std::uint32_t second) {
    return warm_vectors(h, kind, vector, value, second);
}
stamp Engine::warm_operation(Hart& h, std::size_t kind, bool vector, std::uint32_t value,
                             std::uint32_t second, std::uint32_t third) {
    return warm_vectors(h, kind, vector, value, second, third);
}

stamp Engine::warm_scalar(Hart& h, std::size_t kind) {
    if (scalar_moves_ != 0) [[unlikely]]
        charge(h, scalar_moves_, {});
    pass(h, kind, 1);
    count(h, 1, false);
    return {};
}

/// The place at which a thread lets the others come as far as it has.
void Engine::warm_branch(Hart& h, site where, bool taken) {
    end_stretch(h);
    warm_overhead(h);
    pass(h, branch_class, 1);
    count(h, 1, false);
    ++h.counters.branches;
    if (prediction_ == Prediction::counters
            ? !h.core->predictor.right(h.tile->sites.number(where), h.history, taken)
            : prediction_ != Prediction::perfect && prediction_ != Prediction::none &&
                  taken != (prediction_ == Prediction::taken))
        ++h.counters.mispredicts;
    if (h.ahead <= 0)
        pause(h);
}

stamp Engine::warm_load(Hart& h, site where, const void* p, std::uint32_t bytes, bool vector) {
    note_site(h, where);
    const std::uint64_t a = address(p);
    warm_overhead(h);
    pass(h, load_kind, 1);
    translated(h, a, a + bytes - 1, h.now);
    warm_bytes(h, a, bytes, false);
    count(h, 1, vector);
    ++h.counters.loads;
    stamp r;
    r.value = vector ? make_value(h, true) : 0;
    return r;
}

stamp Engine::warm_load_vector(Hart& h, site where, const void* p, std::uint64_t lanes, std::uint32_t mask) {
    warm_values(h, false, false, mask);
    note_site(h, where);
    if ((mask != 0 && masked_by_lane_) || lanes != all_lanes) [[unlikely]]
        return load_vector(h, p, lanes, mask != 0, {});
    warm_overhead(h);
    pass(h, vector_load, pieces_);
    const std::uint64_t a = address(p);
    translated(h, a, a + width * 4 - 1, h.now);
    warm_whole(h, a, false);
    count(h, pieces_, true);
    ++h.counters.loads;
    stamp r;
    r.value = make_value(h, false);
    return r;
}

stamp Engine::warm_gather(Hart& h, site where, const void* p, const std::int32_t* index, std::uint64_t lanes,
                          std::uint32_t indices, std::uint32_t mask) {
    warm_values(h, false, false, indices, mask);
    note_site(h, where);
    warm_overhead(h);
    ++h.counters.gathers;
    assemble_load(h, lanes, {});
    const std::uint32_t instructions = indexed_instructions(lanes, lane_gather_);
    pass(h, vector_load, instructions);
    if (lanes != 0) {
        const std::uint64_t a = address(p);
        if (tlb_)
            translate_indexed(h, a, index, lanes, h.now);
        warm_indexed(h, a, index, lanes, false);
    }
    count(h, instructions, true);
    ++h.counters.loads;
    stamp r;
    r.value = make_value(h, false);
    return r;
}

void Engine::warm_store(Hart& h, site where, const void* p, std::uint32_t bytes) {
    note_site(h, where);
    const std::uint64_t a = address(p);
    pass(h, store_kind, 1);
    translated(h, a, a + bytes - 1, h.now);
    warm_bytes(h, a, bytes, true);
    count(h, 1, false);
    ++h.counters.stores;
}

void Engine::warm_store_vector(Hart& h, site where, const void* p, std::uint64_t lanes, std::uint32_t data,
                               std::uint32_t mask) {
    warm_values(h, false, false, data, mask);
    note_site(h, where);
    if ((mask != 0 && masked_by_lane_) || lanes != all_lanes) [[unlikely]]
        return store_vector(h, p, lanes, mask != 0, {});
    pass(h, vector_store, pieces_);
    const std::uint64_t a = address(p);
    translated(h, a, a + width * 4 - 1, h.now);
    warm_whole(h, a, true);
    count(h, pieces_, true);
    ++h.counters.stores;
}

void Engine::warm_scatter(Hart& h, site where, const void* p, const std::int32_t* index, std::uint64_t lanes,
                          std::uint32_t indices, std::uint32_t data, std::uint32_t mask) {
    warm_values(h, false, false, indices, data, mask);
    note_site(h, where);
    scatter(h, p, index, lanes, {});
}

} // namespace sim
