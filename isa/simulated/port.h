// The timing port: what the simulated target tells the machine and asks of it. Declared here, implemented by whoever is
// linked: sim/ (the machine), or a recorder that only notes what is touched. Plain functions, no virtual calls.
//
// A value of the simulated target is its payload and a stamp. An operation hands over the stamps of its operands and
// gets the stamp of its result. Operands never wait by themselves: a load returns a stamp in the future, or one that
// carries an open ticket whose time is not known yet, and the machine makes whoever uses it wait (stall on use). Rules
// of time 1 to 5.
//
// Addresses are host addresses inside frame memory; the machine turns them into simulated ones by subtracting the base
// of the address space (isa/address_space.h), so that no host address reaches a result.
#pragma once

#include <cstdint>

namespace isa::timing {

using cycle = std::uint64_t;

/// When a value is there: cycles, or the machine's own tickets for cycles that it does not know yet. Scalars have
/// first == last. A default stamp is a constant: always there, in no register.
struct stamp {
    cycle first = 0;         // its first sub-vector
    cycle last = 0;          // its last sub-vector
    std::uint32_t value = 0; // names the value, for finite registers; 0: a constant
    std::uint8_t cause = 0;  // the machine's own note of what the value waited for
};

/// Where in the source an access or branch stands. Both compilers give the line a call begins on.
struct site {
    const char* file;
    std::uint32_t line;
    [[gnu::always_inline]] static constexpr site here(const char* file = __builtin_FILE(),
                                                      int line = __builtin_LINE()) {
        return {file, static_cast<std::uint32_t>(line)};
    }
};

enum class operation : std::uint8_t {
    integer, // add, subtract, logic, shift, min, max, compare of integers
    integer_multiply,
    add, // float add, subtract, min, max
    multiply,
    fused, // fused multiply-add
    divide,
    square_root,
    compare, // float comparison
    convert, // float <-> integer, rounding
    select,
    mask,           // logic on masks and scalar conditions
    broadcast,      // scalar to all lanes
    shuffle,        // permute, compress, extract
    reduce,         // all lanes to one scalar
    mask_to_scalar, // any, all, count, first
    address,        // address arithmetic that no addressing mode folds
};
inline constexpr int operation_kinds = 16;

// --- computation
/// Lane by lane: `n`-slot consumers may follow their operands sub-vector by sub-vector (rule 1).
stamp vector_op(operation op, const stamp& a);
stamp vector_op(operation op, const stamp& a, const stamp& b);
stamp vector_op(operation op, const stamp& a, const stamp& b, const stamp& c);
/// Across lanes: waits for the last sub-vector of its operands. The result is a vector ...
stamp cross_op(operation op, const stamp& a, const stamp& b);
/// ... or a scalar.
stamp cross_to_scalar(operation op, const stamp& a, const stamp& b);
stamp scalar_op(operation op, const stamp& a);
stamp scalar_op(operation op, const stamp& a, const stamp& b);
stamp scalar_op(operation op, const stamp& a, const stamp& b, const stamp& c);
void branch(site where, const stamp& condition, bool taken);

// --- memory. `address` is the stamp of the address operand.
stamp load(site where, const void* p, std::uint32_t bytes, const stamp& address); // scalar
stamp load_broadcast(site where, const void* p, std::uint32_t bytes, const stamp& address);
/// `lanes`: bit i says whether lane i, at p + i*4, is accessed.
stamp load_vector(site where, const void* p, std::uint64_t lanes, const stamp& address, const stamp& mask);
/// Lane i is at p + index[i]*4.
stamp gather(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& mask);
void store(site where, const void* p, std::uint32_t bytes, const stamp& address, const stamp& data);
void store_vector(site where, const void* p, std::uint64_t lanes, const stamp& address, const stamp& data,
                  const stamp& mask);
void scatter(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& data, const stamp& mask);
void prefetch(site where, const void* p, const stamp& address);
void discard(site where, const void* p, std::uint32_t bytes, const stamp& address);

// --- shared words (rule 5). before_atomic returns when the operation may act on the word; the caller then does so at
// once and reports by after_atomic what it read and, if it wrote, that it did. The stamp is that of the value read.
enum class atomic : std::uint8_t { load_acquire, store_release, fetch_add, compare_exchange };
void before_atomic(site where, atomic kind, const void* p, const stamp& address, const stamp& operands);
stamp after_atomic(site where, atomic kind, const void* p, bool wrote);
/// Parks the caller until the word differs from `value`. The stamp is that of the value then read.
stamp wait_while(site where, const std::int32_t* p, std::int32_t value, const stamp& address, const stamp& operand);

// --- the rest
/// Parks the caller; the scheduler makes the page on its own stack, with time standing still.
void request_page(void* service, std::int32_t space, std::int32_t kind, std::int32_t index);
/// Sets the phase that work and traffic count under; returns the one before.
std::int32_t set_phase(std::int32_t phase);
/// Sets the kind of work likewise.
std::int32_t set_kind(std::int32_t kind);
/// Whom they are for likewise: lane i of `lanes` works for owner[i], a number of the caller's; returns a word for whom
/// they were for, to be restored. Takes no time.
std::uint64_t set_owners(const std::int32_t* owner, std::uint64_t lanes);
/// ... of the same owners those of these lanes; of all, as before, where there are none.
std::uint64_t narrow_owners(std::uint64_t lanes);
void restore_owners(std::uint64_t before);
/// Traffic to these bytes counts under this level from now on, or under that of what lies at `other`. Takes no time.
void note_level(const void* p, std::uint64_t bytes, std::int32_t level);
void note_level_of(const void* p, std::uint64_t bytes, const void* other);

} // namespace isa::timing
