// The timing port for tests: everything is there at once, and a listener may follow what happens.
#pragma once

#include "isa/simulated/port.h"

#include <cstdint>
#include <span>

namespace razor::test {

enum class Event : std::uint8_t {
    vector_op,
    cross_op,
    cross_to_scalar,
    scalar_op,
    branch,
    load,
    load_broadcast,
    load_vector,
    gather,
    store,
    store_vector,
    scatter,
    prefetch,
    discard,
    before_atomic,
    after_atomic,
    wait_while,
    request_page,
    phase,
};

class Listener {
public:
    virtual ~Listener() = default;
    /// `detail`: the operation, whether a branch was taken, the phase and the like. `operands`: the numbers
    /// that earlier events gave to their results, 0 for constants. `result`: the number of this event's, or
    /// 0. `where`: of memory operations and branches, else nothing.
    virtual void event(Event kind, isa::timing::site where, std::uint32_t detail,
                       std::span<const std::uint32_t> operands, std::uint32_t result) {
        (void)kind, (void)where, (void)detail, (void)operands, (void)result;
    }
    /// What the event just told does in memory, one call a run of bytes.
    virtual void read(const void* p, std::uint32_t bytes) { (void)p, (void)bytes; }
    virtual void write(const void* p, std::uint32_t bytes) { (void)p, (void)bytes; }
    /// What lies there is said to be dead.
    virtual void discard(const void* p, std::uint32_t bytes) { (void)p, (void)bytes; }
};

/// Who follows what the simulated kernels do from now on, on one thread. Null: nobody, on any.
void listen(Listener* listener);

} // namespace razor::test
