// Simulated scalars: a native scalar and its stamp. Same operations and doc lines as isa/native/scalar.h.
#pragma once

#include "isa/native/memory.h"
#include "isa/simulated/port.h"

namespace isa::simulated {

namespace timing = isa::timing;
using timing::operation;
using timing::stamp;

/// The one door to payload and stamp, for the headers of this folder. Kernels have no business here (checked by the
/// lint).
struct access {
    template <class T> static const auto& value(const T& x) { return x.value_; }
    template <class T> static const stamp& time(const T& x) { return x.time_; }
    template <class T, class V> static T make(const V& value, const stamp& time) {
        T x;
        x.value_ = value;
        x.time_ = time;
        return x;
    }
};

class sbool {
public:
    sbool() = default;
    sbool(bool constant) : value_(constant) {}
    template <class T> sbool(T) = delete;

private:
    friend struct access;
    values::sbool value_;
    stamp time_;
};

class sint {
public:
    sint() = default;
    sint(std::int32_t constant) : value_(constant) {}
    sint(bool) = delete;
    sint(float) = delete;
    sint(double) = delete;

private:
    friend struct access;
    values::sint value_;
    stamp time_;
};

class sfloat {
public:
    sfloat() = default;
    sfloat(float constant) : value_(constant) {}
    sfloat(std::int32_t) = delete;
    sfloat(bool) = delete;
    sfloat(double) = delete;

private:
    friend struct access;
    values::sfloat value_;
    stamp time_;
};

namespace detail {
template <class R, class A, class Op> inline R scalar(operation kind, Op op, const A& a) {
    return access::make<R>(op(access::value(a)), timing::scalar_op(kind, access::time(a)));
}
template <class R, class A, class B, class Op> inline R scalar(operation kind, Op op, const A& a, const B& b) {
    return access::make<R>(op(access::value(a), access::value(b)),
                           timing::scalar_op(kind, access::time(a), access::time(b)));
}
template <class R, class A, class B, class C, class Op>
inline R scalar(operation kind, Op op, const A& a, const B& b, const C& c) {
    return access::make<R>(op(access::value(a), access::value(b), access::value(c)),
                           timing::scalar_op(kind, access::time(a), access::time(b), access::time(c)));
}
} // namespace detail
#define ISA_UNARY(result, name, argument, kind)                                                                        \
    inline result name(const argument& a) {                                                                            \
        return detail::scalar<result>(                                                                                 \
            operation::kind, [](const auto& x) { return name(x); }, a);                                                \
    }
#define ISA_BINARY(result, name, left, right, kind)                                                                    \
    inline result name(const left& a, const right& b) {                                                                \
        return detail::scalar<result>(                                                                                 \
            operation::kind, [](const auto& x, const auto& y) { return name(x, y); }, a, b);                           \
    }
#define ISA_INFIX(result, symbol, left, right, kind)                                                                   \
    inline result operator symbol(const left& a, const right& b) {                                                     \
        return detail::scalar<result>(                                                                                 \
            operation::kind, [](const auto& x, const auto& y) { return x symbol y; }, a, b);                           \
    }

ISA_INFIX(sfloat, +, sfloat, sfloat, add)
ISA_INFIX(sfloat, -, sfloat, sfloat, add)
ISA_INFIX(sfloat, *, sfloat, sfloat, multiply)
ISA_INFIX(sfloat, /, sfloat, sfloat, divide)
inline sfloat operator-(const sfloat& a) {
    return detail::scalar<sfloat>(
        operation::integer, [](const auto& x) { return -x; }, a);
}
#define ISA_FUSED(name)                                                                                                \
    inline sfloat name(const sfloat& a, const sfloat& b, const sfloat& c) {                                            \
        return detail::scalar<sfloat>(                                                                                 \
            operation::fused, [](const auto& x, const auto& y, const auto& z) { return name(x, y, z); }, a, b, c);     \
    }
ISA_FUSED(fma)
ISA_FUSED(fms)
ISA_FUSED(fnma)
ISA_FUSED(product_error)
#undef ISA_FUSED
ISA_BINARY(sfloat, min, sfloat, sfloat, add)
ISA_BINARY(sfloat, max, sfloat, sfloat, add)
ISA_UNARY(sfloat, abs, sfloat, integer)
ISA_UNARY(sfloat, sqrt, sfloat, square_root)
ISA_UNARY(sfloat, floor, sfloat, convert)
ISA_UNARY(sfloat, round_even, sfloat, convert)
ISA_UNARY(sfloat, reciprocal, sfloat, divide)
inline sfloat reciprocal_sqrt(const sfloat& a) { return reciprocal(sqrt(a)); }

ISA_INFIX(sbool, <, sfloat, sfloat, compare)
ISA_INFIX(sbool, <=, sfloat, sfloat, compare)
ISA_INFIX(sbool, >, sfloat, sfloat, compare)
ISA_INFIX(sbool, >=, sfloat, sfloat, compare)
ISA_INFIX(sbool, ==, sfloat, sfloat, compare)
ISA_INFIX(sbool, !=, sfloat, sfloat, compare)

ISA_INFIX(sint, +, sint, sint, integer)
ISA_INFIX(sint, -, sint, sint, integer)
ISA_INFIX(sint, *, sint, sint, integer_multiply)
ISA_INFIX(sint, &, sint, sint, integer)
ISA_INFIX(sint, |, sint, sint, integer)
ISA_INFIX(sint, ^, sint, sint, integer)
ISA_INFIX(sint, <<, sint, sint, integer)
ISA_INFIX(sint, >>, sint, sint, integer)
inline sint operator-(const sint& a) {
    return detail::scalar<sint>(
        operation::integer, [](const auto& x) { return -x; }, a);
}
ISA_BINARY(sint, shift_right_logical, sint, sint, integer)
ISA_BINARY(sint, min, sint, sint, integer)
ISA_BINARY(sint, max, sint, sint, integer)
inline sint& operator+=(sint& a, const sint& b) { return a = a + b; }
inline sint& operator-=(sint& a, const sint& b) { return a = a - b; }
inline sint& operator++(sint& a) { return a = a + sint(1); }
inline sint& operator--(sint& a) { return a = a - sint(1); }
inline sfloat& operator+=(sfloat& a, const sfloat& b) { return a = a + b; }

ISA_INFIX(sbool, <, sint, sint, integer)
ISA_INFIX(sbool, <=, sint, sint, integer)
ISA_INFIX(sbool, >, sint, sint, integer)
ISA_INFIX(sbool, >=, sint, sint, integer)
ISA_INFIX(sbool, ==, sint, sint, integer)
ISA_INFIX(sbool, !=, sint, sint, integer)

ISA_INFIX(sbool, &, sbool, sbool, mask)
ISA_INFIX(sbool, |, sbool, sbool, mask)
ISA_INFIX(sbool, ^, sbool, sbool, mask)
inline sbool operator!(const sbool& a) {
    return detail::scalar<sbool>(
        operation::mask, [](const auto& x) { return !x; }, a);
}
sbool operator&&(const sbool&, const sbool&) = delete;
sbool operator||(const sbool&, const sbool&) = delete;

inline sfloat select(const sbool& m, const sfloat& a, const sfloat& b) {
    return detail::scalar<sfloat>(
        operation::select, [](const auto& x, const auto& y, const auto& z) { return select(x, y, z); }, m, a, b);
}
inline sint select(const sbool& m, const sint& a, const sint& b) {
    return detail::scalar<sint>(
        operation::select, [](const auto& x, const auto& y, const auto& z) { return select(x, y, z); }, m, a, b);
}
ISA_UNARY(sint, to_int, sfloat, convert)
ISA_UNARY(sfloat, to_float, sint, convert)
// Scalars and vectors of floats and integers share registers here: a bit cast is free.
inline sint as_int(const sfloat& a) { return access::make<sint>(as_int(access::value(a)), access::time(a)); }
inline sfloat as_float(const sint& a) { return access::make<sfloat>(as_float(access::value(a)), access::time(a)); }

inline bool branch(const sbool& condition, timing::site where = timing::site::here()) {
    bool taken = access::value(condition).v;
    timing::branch(where, access::time(condition), taken);
    return taken;
}

} // namespace isa::simulated
