// Simulated memory: a native handle and the stamp of its address. Same operations and doc lines as isa/native/memory.h;
// each access also names its site.
#pragma once

#include "isa/simulated/vector.h"

namespace isa::simulated {

template <class T> class pointer {
public:
    pointer() = default;
    explicit pointer(T* host) : value_(host) {}
    template <class U>
    requires std::is_const_v<T> && std::is_same_v<std::remove_const_t<T>, U> pointer(const pointer<U>& p)
        : value_(access::value(p)), time_(access::time(p)) {}

private:
    friend struct access;
    values::pointer<T> value_;
    stamp time_;
};

template <class T> inline pointer<T> operator+(const pointer<T>& p, const sint& n) {
    return access::make<pointer<T>>(access::value(p) + access::value(n),
                                    timing::scalar_op(operation::address, access::time(p), access::time(n)));
}
template <class T> inline pointer<T> operator+(const pointer<T>& p, int n) {
    return access::make<pointer<T>>(access::value(p) + n, access::time(p));
}
template <class T> inline sbool is_null(const pointer<T>& p) {
    return access::make<sbool>(is_null(access::value(p)), timing::scalar_op(operation::integer, access::time(p)));
}
template <class S, class C, class T> inline auto field(const pointer<S>& p, T C::*member) {
    auto value = field(access::value(p), member);
    return access::make<pointer<std::remove_pointer_t<decltype(value.host())>>>(value, access::time(p));
}
template <class U, class T> inline pointer<U> as(const pointer<T>& p) {
    return access::make<pointer<U>>(values::as<U>(access::value(p)), access::time(p));
}
template <class T> inline sint distance(const pointer<T>& a, const pointer<T>& b) {
    return access::make<sint>(distance(access::value(a), access::value(b)),
                              timing::scalar_op(operation::address, access::time(a), access::time(b)));
}

namespace detail {
template <class P> inline const void* host(const P& p) { return access::value(p).host(); }
inline std::uint64_t lanes(const vmask& m) { return values::detail::bits(access::value(m)); }
template <class R, class P> inline R scalar_load(const P& p, timing::site where) {
    stamp t = timing::load(where, host(p), sizeof(*access::value(p).host()), access::time(p));
    return access::make<R>(load(access::value(p)), t);
}
template <class R, class P> inline R broadcast_load(const P& p, timing::site where) {
    stamp t = timing::load_broadcast(where, host(p), sizeof(*access::value(p).host()), access::time(p));
    return access::make<R>(load_broadcast(access::value(p)), t);
}
template <class R, class P> inline R vector_load(const P& p, timing::site where) {
    stamp t = timing::load_vector(where, host(p), values::detail::all_lanes, access::time(p), stamp{});
    return access::make<R>(load_vector(access::value(p)), t);
}
template <class R, class P> inline R vector_load(const P& p, const vmask& m, timing::site where) {
    stamp t = timing::load_vector(where, host(p), lanes(m), access::time(p), access::time(m));
    return access::make<R>(load_vector(access::value(p), access::value(m)), t);
}
template <class R, class P> inline R indexed_load(const P& p, const vint& index, const vmask& m, timing::site where) {
    auto spread = values::detail::spread(access::value(index));
    stamp t = timing::gather(where, host(p), spread.v, lanes(m), access::time(p), access::time(index), access::time(m));
    return access::make<R>(gather(access::value(p), access::value(index), access::value(m)), t);
}
template <class P, class V> inline void scalar_store(const P& p, const V& a, timing::site where) {
    timing::store(where, host(p), sizeof(*access::value(p).host()), access::time(p), access::time(a));
    store(access::value(p), access::value(a));
}
template <class P, class V> inline void vector_store(const P& p, const V& a, const vmask& m, timing::site where) {
    timing::store_vector(where, host(p), lanes(m), access::time(p), access::time(a), access::time(m));
    store_vector(access::value(p), access::value(a), access::value(m));
}
template <class P, class V>
inline void indexed_store(const P& p, const vint& index, const V& a, const vmask& m, timing::site where) {
    auto spread = values::detail::spread(access::value(index));
    timing::scatter(where, host(p), spread.v, lanes(m), access::time(p), access::time(index), access::time(a),
                    access::time(m));
    scatter(access::value(p), access::value(index), access::value(a), access::value(m));
}
} // namespace detail
#define ISA_SITE timing::site where = timing::site::here()

// --- one element
inline sfloat load(const pointer<const float>& p, ISA_SITE) { return detail::scalar_load<sfloat>(p, where); }
inline sint load(const pointer<const std::int32_t>& p, ISA_SITE) { return detail::scalar_load<sint>(p, where); }
inline sfloat load(const pointer<float>& p, ISA_SITE) { return detail::scalar_load<sfloat>(p, where); }
inline sint load(const pointer<std::int32_t>& p, ISA_SITE) { return detail::scalar_load<sint>(p, where); }
template <class E>
requires(std::is_enum_v<E> && sizeof(E) == 4) inline sint load(const pointer<E>& p, ISA_SITE) {
    return detail::scalar_load<sint>(p, where);
}
template <class T> inline pointer<T> load(const pointer<const isa::ref<T>>& p, ISA_SITE) {
    return detail::scalar_load<pointer<T>>(p, where);
}
template <class T> inline pointer<T> load(const pointer<isa::ref<T>>& p, ISA_SITE) {
    return detail::scalar_load<pointer<T>>(p, where);
}
inline void store(const pointer<float>& p, const sfloat& a, ISA_SITE) { detail::scalar_store(p, a, where); }
inline void store(const pointer<std::int32_t>& p, const sint& a, ISA_SITE) { detail::scalar_store(p, a, where); }
template <class T> inline void store(const pointer<isa::ref<T>>& p, const pointer<T>& a, ISA_SITE) {
    detail::scalar_store(p, a, where);
}
inline vfloat load_broadcast(const pointer<const float>& p, ISA_SITE) {
    return detail::broadcast_load<vfloat>(p, where);
}
inline vint load_broadcast(const pointer<const std::int32_t>& p, ISA_SITE) {
    return detail::broadcast_load<vint>(p, where);
}
inline vfloat load_broadcast(const pointer<float>& p, ISA_SITE) { return detail::broadcast_load<vfloat>(p, where); }
inline vint load_broadcast(const pointer<std::int32_t>& p, ISA_SITE) { return detail::broadcast_load<vint>(p, where); }

// --- width consecutive elements
inline vfloat load_vector(const pointer<const float>& p, ISA_SITE) { return detail::vector_load<vfloat>(p, where); }
inline vint load_vector(const pointer<const std::int32_t>& p, ISA_SITE) { return detail::vector_load<vint>(p, where); }
inline vfloat load_vector(const pointer<float>& p, ISA_SITE) { return detail::vector_load<vfloat>(p, where); }
inline vint load_vector(const pointer<std::int32_t>& p, ISA_SITE) { return detail::vector_load<vint>(p, where); }
inline vfloat load_vector(const pointer<const float>& p, const vmask& m, ISA_SITE) {
    return detail::vector_load<vfloat>(p, m, where);
}
inline vint load_vector(const pointer<const std::int32_t>& p, const vmask& m, ISA_SITE) {
    return detail::vector_load<vint>(p, m, where);
}
inline vfloat load_vector(const pointer<float>& p, const vmask& m, ISA_SITE) {
    return detail::vector_load<vfloat>(p, m, where);
}
inline vint load_vector(const pointer<std::int32_t>& p, const vmask& m, ISA_SITE) {
    return detail::vector_load<vint>(p, m, where);
}
inline void store_vector(const pointer<float>& p, const vfloat& a, ISA_SITE) {
    detail::vector_store(p, a, vmask(true), where);
}
inline void store_vector(const pointer<std::int32_t>& p, const vint& a, ISA_SITE) {
    detail::vector_store(p, a, vmask(true), where);
}
inline void store_vector(const pointer<float>& p, const vfloat& a, const vmask& m, ISA_SITE) {
    detail::vector_store(p, a, m, where);
}
inline void store_vector(const pointer<std::int32_t>& p, const vint& a, const vmask& m, ISA_SITE) {
    detail::vector_store(p, a, m, where);
}

// --- indexed elements
inline vfloat gather(const pointer<const float>& p, const vint& index, const vmask& m, ISA_SITE) {
    return detail::indexed_load<vfloat>(p, index, m, where);
}
inline vint gather(const pointer<const std::int32_t>& p, const vint& index, const vmask& m, ISA_SITE) {
    return detail::indexed_load<vint>(p, index, m, where);
}
inline vfloat gather(const pointer<float>& p, const vint& index, const vmask& m, ISA_SITE) {
    return detail::indexed_load<vfloat>(p, index, m, where);
}
inline vint gather(const pointer<std::int32_t>& p, const vint& index, const vmask& m, ISA_SITE) {
    return detail::indexed_load<vint>(p, index, m, where);
}
inline void scatter(const pointer<float>& p, const vint& index, const vfloat& a, const vmask& m, ISA_SITE) {
    detail::indexed_store(p, index, a, m, where);
}
inline void scatter(const pointer<std::int32_t>& p, const vint& index, const vint& a, const vmask& m, ISA_SITE) {
    detail::indexed_store(p, index, a, m, where);
}

// --- hints
template <class T> inline void prefetch(const pointer<T>& p, ISA_SITE) {
    timing::prefetch(where, detail::host(p), access::time(p));
}
template <class T> inline void discard(const pointer<T>& p, const sint& bytes, ISA_SITE) {
    timing::discard(where, detail::host(p), static_cast<std::uint32_t>(access::value(bytes).v), access::time(p));
}

// --- words shared between workers
using shared_word = pointer<isa::shared<std::int32_t>>;
inline sint load_acquire(const shared_word& p, ISA_SITE) {
    timing::before_atomic(where, timing::atomic::load_acquire, detail::host(p), access::time(p), stamp{});
    auto value = load_acquire(access::value(p));
    return access::make<sint>(value, timing::after_atomic(where, timing::atomic::load_acquire, detail::host(p), false));
}
inline void store_release(const shared_word& p, const sint& a, ISA_SITE) {
    timing::before_atomic(where, timing::atomic::store_release, detail::host(p), access::time(p), access::time(a));
    store_release(access::value(p), access::value(a));
    timing::after_atomic(where, timing::atomic::store_release, detail::host(p), true);
}
inline sint fetch_add(const shared_word& p, const sint& a, ISA_SITE) {
    timing::before_atomic(where, timing::atomic::fetch_add, detail::host(p), access::time(p), access::time(a));
    auto before = fetch_add(access::value(p), access::value(a));
    return access::make<sint>(before, timing::after_atomic(where, timing::atomic::fetch_add, detail::host(p), true));
}
inline sint compare_exchange(const shared_word& p, const sint& expected, const sint& desired, ISA_SITE) {
    timing::before_atomic(where, timing::atomic::compare_exchange, detail::host(p), access::time(p),
                          access::time(desired));
    auto before = compare_exchange(access::value(p), access::value(expected), access::value(desired));
    bool wrote = before.v == access::value(expected).v;
    return access::make<sint>(before,
                              timing::after_atomic(where, timing::atomic::compare_exchange, detail::host(p), wrote));
}
inline sint wait_while(const shared_word& p, const sint& value, ISA_SITE) {
    auto* word = &access::value(p).host()->word;
    stamp t = timing::wait_while(where, word, access::value(value).v, access::time(p), access::time(value));
    return access::make<sint>(load_acquire(access::value(p)), t);
}
#undef ISA_SITE

// --- the host
inline void request_page(isa::page_service& service, const sint& space, const sint& kind, const sint& index) {
    timing::request_page(&service, access::value(space).v, access::value(kind).v, access::value(index).v);
}
[[noreturn]] inline void trap(int code) { isa::throw_trapped(code); }
inline void tally(std::int64_t& counter, const sint& n) { counter += access::value(n).v; }
inline void tally(std::int64_t& counter, int n) { counter += n; }
inline void mark(isa::mark_set& set, const sint& i) { set.mark(access::value(i).v); }
inline void note_time(isa::stopwatch&, int) {} // the host's time says nothing of the machine's
inline void note_dropping(isa::memory_log& log, const sint& arena, const sint& last) {
    log.dropping(access::value(arena).v, access::value(last).v);
}
inline void note_event(isa::memory_log& log, int event) { log.note(event); }
inline void begin_lap(isa::lap_timer&) {}
inline void end_lap(isa::lap_timer&, const sint&) {}
namespace detail {
template <class P> inline std::uint64_t bytes_of(const P& p, const sint& count) {
    return static_cast<std::uint64_t>(access::value(count).v) * sizeof(*access::value(p).host());
}
} // namespace detail
template <class T> inline void note_level(const pointer<T>& p, const sint& count, const sint& level, int finer = 0) {
    timing::note_level(detail::host(p), detail::bytes_of(p, count), access::value(level).v - finer);
}
template <class T, class U> inline void note_level_of(const pointer<T>& p, const sint& count, const pointer<U>& other) {
    timing::note_level_of(detail::host(p), detail::bytes_of(p, count), detail::host(other));
}
class phase_scope {
public:
    explicit phase_scope(int phase) : before_(timing::set_phase(phase)) {}
    phase_scope(const phase_scope&) = delete;
    phase_scope& operator=(const phase_scope&) = delete;
    ~phase_scope() { timing::set_phase(before_); }

private:
    std::int32_t before_;
};
class kind_scope {
public:
    explicit kind_scope(int kind) : before_(timing::set_kind(kind)) {}
    kind_scope(const kind_scope&) = delete;
    kind_scope& operator=(const kind_scope&) = delete;
    ~kind_scope() { timing::set_kind(before_); }

private:
    std::int32_t before_;
};
class owner_scope {
public:
    owner_scope(const vint& owner, const vmask& m) {
        auto each = values::detail::spread(access::value(owner));
        before_ = timing::set_owners(each.v, detail::lanes(m));
    }
    owner_scope(const owner_scope&) = delete;
    owner_scope& operator=(const owner_scope&) = delete;
    ~owner_scope() { timing::restore_owners(before_); }

private:
    std::uint64_t before_;
};
class lane_scope {
public:
    explicit lane_scope(const vmask& m) : before_(timing::narrow_owners(detail::lanes(m))) {}
    lane_scope(const lane_scope&) = delete;
    lane_scope& operator=(const lane_scope&) = delete;
    ~lane_scope() { timing::restore_owners(before_); }

private:
    std::uint64_t before_;
};

} // namespace isa::simulated
