#include "tests/kernels/recording_port.h"

#include "isa/services.h"

#include <array>
#include <initializer_list>
#include <thread>
#include <utility>

namespace razor::test {

namespace {

Listener* listener = nullptr;
std::uint32_t values = 0;

} // namespace

void listen(Listener* l) {
    listener = l;
    values = 0;
}

} // namespace razor::test

namespace isa::timing {

using razor::test::Event;
using razor::test::listener;

namespace {

constexpr site nowhere{nullptr, 0};

stamp tell(Event kind, site where, std::uint32_t detail, std::initializer_list<const stamp*> operands) {
    stamp result;
    if (listener == nullptr)
        return result;
    std::array<std::uint32_t, 4> numbers{};
    std::size_t n = 0;
    for (const stamp* s : operands)
        numbers[n++] = s->value;
    result.value = ++razor::test::values;
    listener->event(kind, where, detail, {numbers.data(), n}, result.value);
    return result;
}
stamp tell(Event kind, operation op, std::initializer_list<const stamp*> operands) {
    return tell(kind, nowhere, static_cast<std::uint32_t>(op), operands);
}

void read(const void* p, std::uint32_t bytes) {
    if (listener != nullptr)
        listener->read(p, bytes);
}
void write(const void* p, std::uint32_t bytes) {
    if (listener != nullptr)
        listener->write(p, bytes);
}

template <class Visit>
void each_lane(const void* p, const std::int32_t* index, std::uint64_t lanes, Visit visit) {
    if (listener == nullptr)
        return;
    const auto* words = static_cast<const std::int32_t*>(p);
    for (int i = 0; i < 64; ++i)
        if ((lanes >> i & 1) != 0)
            visit(words + (index == nullptr ? i : index[i]));
}
void read_lanes(const void* p, const std::int32_t* index, std::uint64_t lanes) {
    each_lane(p, index, lanes, [](const void* word) { listener->read(word, 4); });
}
void write_lanes(const void* p, const std::int32_t* index, std::uint64_t lanes) {
    each_lane(p, index, lanes, [](const void* word) { listener->write(word, 4); });
}

} // namespace

stamp vector_op(operation op, const stamp& a) {
    return tell(Event::vector_op, op, {&a});
}
stamp vector_op(operation op, const stamp& a, const stamp& b) {
    return tell(Event::vector_op, op, {&a, &b});
}
stamp vector_op(operation op, const stamp& a, const stamp& b, const stamp& c) {
    return tell(Event::vector_op, op, {&a, &b, &c});
}
stamp cross_op(operation op, const stamp& a, const stamp& b) {
    return tell(Event::cross_op, op, {&a, &b});
}
stamp cross_to_scalar(operation op, const stamp& a, const stamp& b) {
    return tell(Event::cross_to_scalar, op, {&a, &b});
}
stamp scalar_op(operation op, const stamp& a) {
    return tell(Event::scalar_op, op, {&a});
}
stamp scalar_op(operation op, const stamp& a, const stamp& b) {
    return tell(Event::scalar_op, op, {&a, &b});
}
stamp scalar_op(operation op, const stamp& a, const stamp& b, const stamp& c) {
    return tell(Event::scalar_op, op, {&a, &b, &c});
}
void branch(site where, const stamp& condition, bool taken) {
    tell(Event::branch, where, taken ? 1 : 0, {&condition});
}

stamp load(site where, const void* p, std::uint32_t bytes, const stamp& address) {
    stamp s = tell(Event::load, where, bytes, {&address});
    read(p, bytes);
    return s;
}
stamp load_broadcast(site where, const void* p, std::uint32_t bytes, const stamp& address) {
    stamp s = tell(Event::load_broadcast, where, bytes, {&address});
    read(p, bytes);
    return s;
}
stamp load_vector(site where, const void* p, std::uint64_t lanes, const stamp& address, const stamp& mask) {
    stamp s = tell(Event::load_vector, where, 0, {&address, &mask});
    read_lanes(p, nullptr, lanes);
    return s;
}
stamp gather(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& mask) {
    stamp s = tell(Event::gather, where, 0, {&address, &indices, &mask});
    read_lanes(p, index, lanes);
    return s;
}
void store(site where, const void* p, std::uint32_t bytes, const stamp& address, const stamp& data) {
    tell(Event::store, where, bytes, {&address, &data});
    write(p, bytes);
}
void store_vector(site where, const void* p, std::uint64_t lanes, const stamp& address, const stamp& data,
                  const stamp& mask) {
    tell(Event::store_vector, where, 0, {&address, &data, &mask});
    write_lanes(p, nullptr, lanes);
}
void scatter(site where, const void* p, const std::int32_t* index, std::uint64_t lanes, const stamp& address,
             const stamp& indices, const stamp& data, const stamp& mask) {
    tell(Event::scatter, where, 0, {&address, &indices, &data, &mask});
    write_lanes(p, index, lanes);
}
void prefetch(site where, const void*, const stamp& address) {
    tell(Event::prefetch, where, 0, {&address});
}
void discard(site where, const void* p, std::uint32_t bytes, const stamp& address) {
    tell(Event::discard, where, bytes, {&address});
    if (listener != nullptr)
        listener->discard(p, bytes);
}

void before_atomic(site where, atomic kind, const void* p, const stamp& address, const stamp& operands) {
    tell(Event::before_atomic, where, static_cast<std::uint32_t>(kind), {&address, &operands});
    if (kind != atomic::store_release)
        read(p, 4);
}
stamp after_atomic(site where, atomic kind, const void* p, bool wrote) {
    stamp s = tell(Event::after_atomic, where, static_cast<std::uint32_t>(kind), {});
    if (wrote)
        write(p, 4);
    return s;
}
stamp wait_while(site where, const std::int32_t* p, std::int32_t value, const stamp& address,
                 const stamp& operand) {
    stamp s = tell(Event::wait_while, where, static_cast<std::uint32_t>(value), {&address, &operand});
    read(p, 4);
    while (__atomic_load_n(p, __ATOMIC_ACQUIRE) == value)
        std::this_thread::yield();
    return s;
}

void request_page(void* service, std::int32_t space, std::int32_t kind, std::int32_t index) {
    tell(Event::request_page, nowhere, static_cast<std::uint32_t>(index), {});
    static_cast<isa::page_service*>(service)->make_page(space, kind, index);
}
std::int32_t set_phase(std::int32_t phase) {
    static thread_local std::int32_t current = 0;
    std::int32_t before = current;
    current = phase;
    tell(Event::phase, nowhere, static_cast<std::uint32_t>(phase), {});
    return before;
}
std::int32_t set_kind(std::int32_t kind) {
    static thread_local std::int32_t current = 0;
    return std::exchange(current, kind);
}
std::uint64_t set_owners(const std::int32_t*, std::uint64_t) {
    return 0;
}
std::uint64_t narrow_owners(std::uint64_t) {
    return 0;
}
void restore_owners(std::uint64_t) {}
void note_level(const void*, std::uint64_t, std::int32_t) {}
void note_level_of(const void*, std::uint64_t, const void*) {}

} // namespace isa::timing
