// Native memory of the vocabulary: typed handles and everything that may be done through them. A handle
// cannot be dereferenced or converted; one memory operation, branch or atomic per full expression.
#pragma once

#include "isa/memory_types.h"
#include "isa/native/vector.h"
#include "isa/services.h"

#include <cstddef>
#include <sched.h>
#include <type_traits>

namespace ISA_NATIVE {

/// A handle to a T in frame memory, or to the first of many.
template <class T> class pointer {
public:
    pointer() = default;
    /// Host code only: where a kernel's arguments come from.
    explicit pointer(T* host) : host_(host) {}
    template <class U>
    requires std::is_const_v<T> && std::is_same_v<std::remove_const_t<T>, U> pointer(pointer<U> p) : host_(p.host()) {}
    T* host() const { return host_; }

private:
    T* host_ = nullptr;
};

// --- addresses
/// The n-th T after p.
template <class T> inline pointer<T> operator+(pointer<T> p, sint n) { return pointer<T>(p.host() + n.v); }
/// The constant step is folded into the address of the access.
template <class T> inline pointer<T> operator+(pointer<T> p, int n) { return pointer<T>(p.host() + n); }
template <class T> inline sbool is_null(pointer<T> p) { return p.host() == nullptr; }
/// A member, or the first element of a member array: folded into the address of the access.
template <class S, class C, class T> inline auto field(pointer<S> p, T C::*member) {
    if constexpr (std::is_array_v<T>)
        return pointer<std::conditional_t<std::is_const_v<S>, const std::remove_extent_t<T>, std::remove_extent_t<T>>>(
            &(p.host()->*member)[0]);
    else
        return pointer<std::conditional_t<std::is_const_v<S>, const T, T>>(&(p.host()->*member));
}
/// The same address, seen as another type of the same or smaller alignment.
template <class U, class T> inline pointer<U> as(pointer<T> p) { return pointer<U>(reinterpret_cast<U*>(p.host())); }
/// Distance from a to b in elements; both into one array of fewer than 2^31.
template <class T> inline sint distance(pointer<T> a, pointer<T> b) {
    return static_cast<std::int32_t>(b.host() - a.host());
}

// --- one element
inline sfloat load(pointer<const float> p) { return *p.host(); }
inline sint load(pointer<const std::int32_t> p) { return *p.host(); }
inline sfloat load(pointer<float> p) { return *p.host(); }
inline sint load(pointer<std::int32_t> p) { return *p.host(); }
/// An enumeration of 32 bits loads as its number.
template <class E>
requires(std::is_enum_v<E> && sizeof(E) == 4) inline sint load(pointer<E> p) {
    return static_cast<std::int32_t>(*p.host());
}
template <class T> inline pointer<T> load(pointer<const isa::ref<T>> p) { return pointer<T>(p.host()->get()); }
template <class T> inline pointer<T> load(pointer<isa::ref<T>> p) { return pointer<T>(p.host()->get()); }
inline void store(pointer<float> p, sfloat a) { *p.host() = a.v; }
inline void store(pointer<std::int32_t> p, sint a) { *p.host() = a.v; }
template <class T> inline void store(pointer<isa::ref<T>> p, pointer<T> a) { p.host()->set(a.host()); }
/// Loads one element into every lane: one access.
inline vfloat load_broadcast(pointer<const float> p) { return vfloat(*p.host()); }
inline vint load_broadcast(pointer<const std::int32_t> p) { return vint(*p.host()); }
inline vfloat load_broadcast(pointer<float> p) { return vfloat(*p.host()); }
inline vint load_broadcast(pointer<std::int32_t> p) { return vint(*p.host()); }

// --- width consecutive elements. Masked-off lanes are not accessed; they load as 0.
namespace detail {
template <class V, class T> inline V vector_load(const T* p) {
    V a;
    detail::each_register([&](int i) { a.r[i] = reg::load(p + i * reg::lanes); });
    return a;
}
template <class V, class T> inline V vector_load(const T* p, const vmask& m) {
    V a;
    detail::each_register([&](int i) { a.r[i] = reg::load(p + i * reg::lanes, m.r[i]); });
    return a;
}
template <class V, class T> inline V vector_gather(const T* p, const vint& index, const vmask& m) {
    V a;
    detail::each_register([&](int i) { a.r[i] = reg::gather(p, index.r[i], m.r[i]); });
    return a;
}
} // namespace detail
inline vfloat load_vector(pointer<const float> p) { return detail::vector_load<vfloat>(p.host()); }
inline vint load_vector(pointer<const std::int32_t> p) { return detail::vector_load<vint>(p.host()); }
inline vfloat load_vector(pointer<float> p) { return detail::vector_load<vfloat>(p.host()); }
inline vint load_vector(pointer<std::int32_t> p) { return detail::vector_load<vint>(p.host()); }
inline vfloat load_vector(pointer<const float> p, const vmask& m) { return detail::vector_load<vfloat>(p.host(), m); }
inline vint load_vector(pointer<const std::int32_t> p, const vmask& m) {
    return detail::vector_load<vint>(p.host(), m);
}
inline vfloat load_vector(pointer<float> p, const vmask& m) { return detail::vector_load<vfloat>(p.host(), m); }
inline vint load_vector(pointer<std::int32_t> p, const vmask& m) { return detail::vector_load<vint>(p.host(), m); }
inline void store_vector(pointer<float> p, const vfloat& a) {
    detail::each_register([&](int i) { reg::store(p.host() + i * reg::lanes, a.r[i]); });
}
inline void store_vector(pointer<std::int32_t> p, const vint& a) {
    detail::each_register([&](int i) { reg::store(p.host() + i * reg::lanes, a.r[i]); });
}
inline void store_vector(pointer<float> p, const vfloat& a, const vmask& m) {
    detail::each_register([&](int i) { reg::store(p.host() + i * reg::lanes, a.r[i], m.r[i]); });
}
inline void store_vector(pointer<std::int32_t> p, const vint& a, const vmask& m) {
    detail::each_register([&](int i) { reg::store(p.host() + i * reg::lanes, a.r[i], m.r[i]); });
}

// --- indexed elements: p[index], index counting elements (signed 32 bits). Masked-off lanes as above.
inline vfloat gather(pointer<const float> p, const vint& index, const vmask& m) {
    return detail::vector_gather<vfloat>(p.host(), index, m);
}
inline vint gather(pointer<const std::int32_t> p, const vint& index, const vmask& m) {
    return detail::vector_gather<vint>(p.host(), index, m);
}
inline vfloat gather(pointer<float> p, const vint& index, const vmask& m) {
    return detail::vector_gather<vfloat>(p.host(), index, m);
}
inline vint gather(pointer<std::int32_t> p, const vint& index, const vmask& m) {
    return detail::vector_gather<vint>(p.host(), index, m);
}
/// Lanes are written in ascending order: of equal indices the highest set lane stays.
inline void scatter(pointer<float> p, const vint& index, const vfloat& a, const vmask& m) {
    detail::each_register([&](int i) { reg::scatter(p.host(), index.r[i], a.r[i], m.r[i]); });
}
inline void scatter(pointer<std::int32_t> p, const vint& index, const vint& a, const vmask& m) {
    detail::each_register([&](int i) { reg::scatter(p.host(), index.r[i], a.r[i], m.r[i]); });
}

// --- hints
inline void prefetch(pointer<const void> p) { __builtin_prefetch(p.host()); }
/// The contents of these bytes are dead: a cache need not write them back. Natively nothing.
template <class T> inline void discard(pointer<T>, sint /*bytes*/) {}

// --- words shared between workers. Sequences of plain stores before a release are seen after the acquire
// that reads it.
inline sint load_acquire(pointer<isa::shared<std::int32_t>> p) {
    return __atomic_load_n(&p.host()->word, __ATOMIC_ACQUIRE);
}
inline void store_release(pointer<isa::shared<std::int32_t>> p, sint a) {
    __atomic_store_n(&p.host()->word, a.v, __ATOMIC_RELEASE);
}
/// Adds; returns the value before.
inline sint fetch_add(pointer<isa::shared<std::int32_t>> p, sint a) {
    return __atomic_fetch_add(&p.host()->word, a.v, __ATOMIC_ACQ_REL);
}
/// Stores `desired` if the word is `expected`; returns the value before.
inline sint compare_exchange(pointer<isa::shared<std::int32_t>> p, sint expected, sint desired) {
    std::int32_t before = expected.v;
    __atomic_compare_exchange_n(&p.host()->word, &before, desired.v, false, __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE);
    return before;
}
/// Waits until the word is no longer `value`; returns what it is then.
inline sint wait_while(pointer<isa::shared<std::int32_t>> p, sint value) {
    for (int spin = 0;; ++spin) {
        sint now = load_acquire(p);
        if (now.v != value.v)
            return now;
        if (spin < 64)
            __builtin_ia32_pause();
        else
            sched_yield();
    }
}

// --- the host
/// Makes a topology page present (isa/services.h). In the simulated machine time stands still meanwhile.
inline void request_page(isa::page_service& service, sint space, sint kind, sint index) {
    service.make_page(space.v, kind.v, index.v);
}
/// Gives up: the host catches isa::trapped in the worker's outermost call.
[[noreturn]] inline void trap(int code) { isa::throw_trapped(code); }
/// Instrumentation, not part of the machine: adds to a counter of the host and costs no simulated time.
inline void tally(std::int64_t& counter, sint n) { counter += n.v; }
inline void tally(std::int64_t& counter, int n) { counter += n; }
/// Likewise: something has happened, and when an event first did.
inline void mark(isa::mark_set& set, sint i) { set.mark(i.v); }
inline void note_time(isa::stopwatch& watch, int event) { watch.note(event); }
/// Likewise: how long each lap takes, numbered as the caller does.
inline void begin_lap(isa::lap_timer& timer) { timer.begin(); }
inline void end_lap(isa::lap_timer& timer, sint lap) { timer.end(lap.v); }
/// Likewise: what becomes of memory that has a budget.
inline void note_dropping(isa::memory_log& log, sint arena, sint last) { log.dropping(arena.v, last.v); }
inline void note_event(isa::memory_log& log, int event) { log.note(event); }
/// Likewise: traffic to `count` records counts under `level` - `finer` from now on, or under the level of `other`'s
/// record (simulated machine). Natively nothing.
template <class T> inline void note_level(pointer<T>, sint /*count*/, sint /*level*/, int /*finer*/ = 0) {}
template <class T, class U> inline void note_level_of(pointer<T>, sint /*count*/, pointer<U> /*other*/) {}
/// Until its end, work and traffic count under this phase of the frame (simulated machine). Natively nothing.
class phase_scope {
public:
    explicit phase_scope(int) {}
    phase_scope(const phase_scope&) = delete;
    phase_scope& operator=(const phase_scope&) = delete;
    ~phase_scope() {} // not trivial: an unused scope warns on no target
};
/// Likewise: under this kind of work, whatever the phase.
class kind_scope {
public:
    explicit kind_scope(int) {}
    kind_scope(const kind_scope&) = delete;
    kind_scope& operator=(const kind_scope&) = delete;
    ~kind_scope() {}
};
/// Likewise: for whom they are, each active lane for a number of its own, such as that of a pixel.
class owner_scope {
public:
    owner_scope(const vint&, const vmask&) {}
    owner_scope(const owner_scope&) = delete;
    owner_scope& operator=(const owner_scope&) = delete;
    ~owner_scope() {}
};
/// Likewise: of those, for these lanes' alone; where no lane is active, for all of them as before.
class lane_scope {
public:
    explicit lane_scope(const vmask&) {}
    lane_scope(const lane_scope&) = delete;
    lane_scope& operator=(const lane_scope&) = delete;
    ~lane_scope() {}
};

} // namespace ISA_NATIVE
