// Simulated vectors: a native vector and its stamp. Same operations and doc lines as isa/native/vector.h.
#pragma once

#include "isa/simulated/scalar.h"

#include <concepts>

namespace isa::simulated {

class vfloat {
public:
    vfloat() = default;
    vfloat(float constant) : value_(constant) {}
    vfloat(const sfloat& a)
        : value_(access::value(a)), time_(timing::vector_op(operation::broadcast, access::time(a))) {}
    vfloat(std::int32_t) = delete;
    vfloat(double) = delete;

private:
    friend struct access;
    values::vfloat value_;
    stamp time_;
};
class vint {
public:
    vint() = default;
    vint(std::int32_t constant) : value_(constant) {}
    vint(const sint& a) : value_(access::value(a)), time_(timing::vector_op(operation::broadcast, access::time(a))) {}
    vint(float) = delete;
    vint(double) = delete;

private:
    friend struct access;
    values::vint value_;
    stamp time_;
};
class vmask {
public:
    vmask() = default;
    vmask(bool constant) : value_(constant) {}
    vmask(const sbool& a) : value_(access::value(a)), time_(timing::vector_op(operation::broadcast, access::time(a))) {}
    template <class T> vmask(T) = delete;

private:
    friend struct access;
    values::vmask value_;
    stamp time_;
};

namespace detail {
template <class R, class A, class Op> inline R lanewise(operation kind, Op op, const A& a) {
    return access::make<R>(op(access::value(a)), timing::vector_op(kind, access::time(a)));
}
template <class R, class A, class B, class Op> inline R lanewise(operation kind, Op op, const A& a, const B& b) {
    return access::make<R>(op(access::value(a), access::value(b)),
                           timing::vector_op(kind, access::time(a), access::time(b)));
}
template <class R, class A, class B, class C, class Op>
inline R lanewise(operation kind, Op op, const A& a, const B& b, const C& c) {
    return access::make<R>(op(access::value(a), access::value(b), access::value(c)),
                           timing::vector_op(kind, access::time(a), access::time(b), access::time(c)));
}
} // namespace detail
#undef ISA_UNARY
#undef ISA_BINARY
#undef ISA_INFIX
#define ISA_UNARY(result, name, argument, kind)                                                                        \
    inline result name(const argument& a) {                                                                            \
        return detail::lanewise<result>(                                                                               \
            operation::kind, [](const auto& x) { return name(x); }, a);                                                \
    }
#define ISA_BINARY(result, name, left, right, kind)                                                                    \
    inline result name(const left& a, const right& b) {                                                                \
        return detail::lanewise<result>(                                                                               \
            operation::kind, [](const auto& x, const auto& y) { return name(x, y); }, a, b);                           \
    }
#define ISA_TERNARY(result, name, first, second, third, kind)                                                          \
    inline result name(const first& a, const second& b, const third& c) {                                              \
        return detail::lanewise<result>(                                                                               \
            operation::kind, [](const auto& x, const auto& y, const auto& z) { return name(x, y, z); }, a, b, c);      \
    }
#define ISA_INFIX(result, symbol, left, right, kind)                                                                   \
    inline result operator symbol(const left& a, const right& b) {                                                     \
        return detail::lanewise<result>(                                                                               \
            operation::kind, [](const auto& x, const auto& y) { return x symbol y; }, a, b);                           \
    }

ISA_INFIX(vfloat, +, vfloat, vfloat, add)
ISA_INFIX(vfloat, -, vfloat, vfloat, add)
ISA_INFIX(vfloat, *, vfloat, vfloat, multiply)
ISA_INFIX(vfloat, /, vfloat, vfloat, divide)
ISA_TERNARY(vfloat, fma, vfloat, vfloat, vfloat, fused)
ISA_TERNARY(vfloat, fms, vfloat, vfloat, vfloat, fused)
ISA_TERNARY(vfloat, fnma, vfloat, vfloat, vfloat, fused)
ISA_TERNARY(vfloat, product_error, vfloat, vfloat, vfloat, fused)
ISA_BINARY(vfloat, min, vfloat, vfloat, add)
ISA_BINARY(vfloat, max, vfloat, vfloat, add)
ISA_UNARY(vfloat, sqrt, vfloat, square_root)
ISA_UNARY(vfloat, floor, vfloat, convert)
ISA_UNARY(vfloat, round_even, vfloat, convert)
ISA_UNARY(vfloat, reciprocal, vfloat, divide)
inline vfloat reciprocal_sqrt(const vfloat& a) { return reciprocal(sqrt(a)); }

ISA_INFIX(vmask, <, vfloat, vfloat, compare)
ISA_INFIX(vmask, <=, vfloat, vfloat, compare)
ISA_INFIX(vmask, >, vfloat, vfloat, compare)
ISA_INFIX(vmask, >=, vfloat, vfloat, compare)
ISA_INFIX(vmask, ==, vfloat, vfloat, compare)
ISA_INFIX(vmask, !=, vfloat, vfloat, compare)

ISA_INFIX(vint, +, vint, vint, integer)
ISA_INFIX(vint, -, vint, vint, integer)
ISA_INFIX(vint, *, vint, vint, integer_multiply)
ISA_INFIX(vint, &, vint, vint, integer)
ISA_INFIX(vint, |, vint, vint, integer)
ISA_INFIX(vint, ^, vint, vint, integer)
ISA_INFIX(vint, <<, vint, vint, integer)
ISA_INFIX(vint, >>, vint, vint, integer)
ISA_BINARY(vint, shift_right_logical, vint, vint, integer)
template <std::same_as<vint> V> inline vint operator<<(const V& a, int n) {
    return detail::lanewise<vint>(
        operation::integer, [n](const auto& x) { return x << n; }, a);
}
template <std::same_as<vint> V> inline vint operator>>(const V& a, int n) {
    return detail::lanewise<vint>(
        operation::integer, [n](const auto& x) { return x >> n; }, a);
}
template <std::same_as<vint> V> inline vint shift_right_logical(const V& a, int n) {
    return detail::lanewise<vint>(
        operation::integer, [n](const auto& x) { return shift_right_logical(x, n); }, a);
}
ISA_BINARY(vint, min, vint, vint, integer)
ISA_BINARY(vint, max, vint, vint, integer)
ISA_INFIX(vmask, <, vint, vint, integer)
ISA_INFIX(vmask, <=, vint, vint, integer)
ISA_INFIX(vmask, >, vint, vint, integer)
ISA_INFIX(vmask, >=, vint, vint, integer)
ISA_INFIX(vmask, ==, vint, vint, integer)
ISA_INFIX(vmask, !=, vint, vint, integer)

ISA_INFIX(vmask, &, vmask, vmask, mask)
ISA_INFIX(vmask, |, vmask, vmask, mask)
ISA_INFIX(vmask, ^, vmask, vmask, mask)
inline vmask operator!(const vmask& a) {
    return detail::lanewise<vmask>(
        operation::mask, [](const auto& x) { return !x; }, a);
}
vmask operator&&(const vmask&, const vmask&) = delete;
vmask operator||(const vmask&, const vmask&) = delete;

ISA_TERNARY(vfloat, select, vmask, vfloat, vfloat, select)
ISA_TERNARY(vint, select, vmask, vint, vint, select)
ISA_UNARY(vint, to_int, vfloat, convert)
ISA_UNARY(vfloat, to_float, vint, convert)
inline vint as_int(const vfloat& a) { return access::make<vint>(as_int(access::value(a)), access::time(a)); }
inline vfloat as_float(const vint& a) { return access::make<vfloat>(as_float(access::value(a)), access::time(a)); }
inline vfloat operator-(const vfloat& a) {
    return detail::lanewise<vfloat>(
        operation::integer, [](const auto& x) { return -x; }, a);
}
ISA_UNARY(vfloat, abs, vfloat, integer)

// --- masks to scalars, and reductions: wait for the last sub-vector
namespace detail {
template <class R, class A, class Op> inline R to_scalar(operation kind, Op op, const A& a) {
    return access::make<R>(op(access::value(a)), timing::cross_to_scalar(kind, access::time(a), stamp{}));
}
template <class R, class A, class B, class Op> inline R crossing(operation kind, Op op, const A& a, const B& b) {
    return access::make<R>(op(access::value(a), access::value(b)),
                           timing::cross_op(kind, access::time(a), access::time(b)));
}
} // namespace detail
#define ISA_TO_SCALAR(result, name, argument, kind)                                                                    \
    inline result name(const argument& a) {                                                                            \
        return detail::to_scalar<result>(                                                                              \
            operation::kind, [](const auto& x) { return name(x); }, a);                                                \
    }
ISA_TO_SCALAR(sbool, any, vmask, mask_to_scalar)
ISA_TO_SCALAR(sbool, all, vmask, mask_to_scalar)
ISA_TO_SCALAR(sbool, none, vmask, mask_to_scalar)
ISA_TO_SCALAR(sint, count, vmask, mask_to_scalar)
ISA_TO_SCALAR(sint, first, vmask, mask_to_scalar)
ISA_TO_SCALAR(sfloat, reduce_add, vfloat, reduce)
ISA_TO_SCALAR(sfloat, reduce_min, vfloat, reduce)
ISA_TO_SCALAR(sfloat, reduce_max, vfloat, reduce)
ISA_TO_SCALAR(sint, reduce_add, vint, reduce)
ISA_TO_SCALAR(sint, reduce_min, vint, reduce)
ISA_TO_SCALAR(sint, reduce_max, vint, reduce)

inline vmask clear_first(const vmask& m) {
    return access::make<vmask>(clear_first(access::value(m)),
                               timing::cross_op(operation::mask, access::time(m), stamp{}));
}
inline vmask first_lanes(const sint& n) {
    return access::make<vmask>(first_lanes(access::value(n)), timing::vector_op(operation::broadcast, access::time(n)));
}
/// A constant: no cost.
inline vint lane_index() { return access::make<vint>(values::lane_index(), stamp{}); }
inline vfloat permute(const vfloat& a, const vint& index) {
    return detail::crossing<vfloat>(
        operation::shuffle, [](const auto& x, const auto& y) { return permute(x, y); }, a, index);
}
inline vint permute(const vint& a, const vint& index) {
    return detail::crossing<vint>(
        operation::shuffle, [](const auto& x, const auto& y) { return permute(x, y); }, a, index);
}
inline vfloat compress(const vfloat& a, const vmask& m) {
    return detail::crossing<vfloat>(
        operation::shuffle, [](const auto& x, const auto& y) { return compress(x, y); }, a, m);
}
inline vint compress(const vint& a, const vmask& m) {
    return detail::crossing<vint>(
        operation::shuffle, [](const auto& x, const auto& y) { return compress(x, y); }, a, m);
}
inline sfloat extract(const vfloat& a, const sint& lane) {
    return access::make<sfloat>(extract(access::value(a), access::value(lane)),
                                timing::cross_to_scalar(operation::shuffle, access::time(a), access::time(lane)));
}
inline sint extract(const vint& a, const sint& lane) {
    return access::make<sint>(extract(access::value(a), access::value(lane)),
                              timing::cross_to_scalar(operation::shuffle, access::time(a), access::time(lane)));
}

#undef ISA_UNARY
#undef ISA_BINARY
#undef ISA_TERNARY
#undef ISA_INFIX
#undef ISA_TO_SCALAR

} // namespace isa::simulated
