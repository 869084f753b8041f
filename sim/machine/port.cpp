// The timing port (isa/simulated/port.h): each function gathers when its operands are there and hands over to
// the engine.
#include "sim/machine/engine.h"

namespace isa::timing {
namespace {

using sim::Due;
using sim::Engine;
using sim::Hart;

Engine& engine() {
    return *sim::running_engine;
}
Hart& hart() {
    return *sim::running_hart;
}
int index(operation op) {
    return static_cast<int>(op);
}

} // namespace

stamp vector_op(operation op, const stamp& a) {
    Due ready = engine().begin(hart());
    engine().need_lanes(hart(), ready, a);
    return engine().compute(hart(), index(op), engine().vector_instructions(), ready, true);
}
stamp vector_op(operation op, const stamp& a, const stamp& b) {
    Due ready = engine().begin(hart());
    engine().need_lanes(hart(), ready, a);
    engine().need_lanes(hart(), ready, b);
    return engine().compute(hart(), index(op), engine().vector_instructions(), ready, true);
}
stamp vector_op(operation op, const stamp& a, const stamp& b, const stamp& c) {
    Due ready = engine().begin(hart());
    engine().need_lanes(hart(), ready, a);
    engine().need_lanes(hart(), ready, b);
    engine().need_lanes(hart(), ready, c);
    return engine().compute(hart(), index(op), engine().vector_instructions(), ready, true);
}
stamp cross_op(operation op, const stamp& a, const stamp& b) {
    Due ready = engine().begin(hart());
    engine().need_all(hart(), ready, a);
    engine().need_all(hart(), ready, b);
    return engine().compute(hart(), index(op), engine().vector_instructions(), ready, true);
}
stamp cross_to_scalar(operation op, const stamp& a, const stamp& b) {
    Due ready = engine().begin(hart());
    engine().need_all(hart(), ready, a);
    engine().need_all(hart(), ready, b);
    return engine().compute(hart(), index(op), engine().vector_instructions(), ready, false);
}
stamp scalar_op(operation op, const stamp& a) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, a);
    return engine().compute(hart(), index(op), 1, ready, false);
}
stamp scalar_op(operation op, const stamp& a, const stamp& b) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, a);
    engine().need_scalar(ready, b);
    return engine().compute(hart(), index(op), 1, ready, false);
}
stamp scalar_op(operation op, const stamp& a, const stamp& b, const stamp& c) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, a);
    engine().need_scalar(ready, b);
    engine().need_scalar(ready, c);
    return engine().compute(hart(), index(op), 1, ready, false);
}
void branch(site where, const stamp& condition, bool taken) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, condition);
    engine().branch(hart(), where, ready, taken);
}

stamp load(site, const void* p, std::uint32_t bytes, const stamp& address) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    return engine().load(hart(), p, bytes, ready, false);
}
stamp load_broadcast(site, const void* p, std::uint32_t bytes, const stamp& address) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    return engine().load(hart(), p, bytes, ready, true);
}
stamp load_vector(site, const void* p, std::uint64_t lanes, const stamp& address, const stamp& mask) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_lanes(hart(), ready, mask);
    return engine().load_vector(hart(), p, lanes, ready);
}
stamp gather(site, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& mask) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_lanes(hart(), ready, indices);
    engine().need_lanes(hart(), ready, mask);
    return engine().gather(hart(), p, index, lanes, ready);
}
void store(site, const void* p, std::uint32_t bytes, const stamp& address, const stamp& data) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_scalar(ready, data);
    engine().store(hart(), p, bytes, ready);
}
void store_vector(site, const void* p, std::uint64_t lanes, const stamp& address, const stamp& data,
                  const stamp& mask) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_lanes(hart(), ready, data);
    engine().need_lanes(hart(), ready, mask);
    engine().store_vector(hart(), p, lanes, ready);
}
void scatter(site, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& data, const stamp& mask) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_lanes(hart(), ready, indices);
    engine().need_lanes(hart(), ready, data);
    engine().need_lanes(hart(), ready, mask);
    engine().scatter(hart(), p, index, lanes, ready);
}
void prefetch(site, const void* p, const stamp& address) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().prefetch(hart(), p, ready);
}
void discard(site, const void* p, std::uint32_t bytes, const stamp& address) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().discard(hart(), p, bytes, ready);
}

void before_atomic(site, atomic kind, const void*, const stamp& address, const stamp& operands) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_scalar(ready, operands);
    engine().before_atomic(hart(), kind, ready);
}
stamp after_atomic(site, atomic kind, const void* p, bool wrote) {
    return engine().after_atomic(hart(), kind, p, wrote);
}
stamp wait_while(site, const std::int32_t* p, std::int32_t value, const stamp& address,
                 const stamp& operand) {
    Due ready = engine().begin(hart());
    engine().need_scalar(ready, address);
    engine().need_scalar(ready, operand);
    return engine().wait_while(hart(), p, value, ready);
}

void request_page(void* service, std::int32_t space, std::int32_t kind, std::int32_t index) {
    engine().request_page(hart(), *static_cast<isa::page_service*>(service), space, kind, index);
}
std::int32_t set_phase(std::int32_t phase) {
    return static_cast<std::int32_t>(engine().set_phase(hart(), static_cast<std::size_t>(phase)));
}

} // namespace isa::timing
