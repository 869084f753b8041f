// Registers of the portable target: loops over small arrays. The oracle of the operation tests.
// Sections, the same in every registers_*.h: types, float arithmetic, float comparison, integers, masks,
// conversion, memory, within one register, across registers.
#pragma once

#include "isa/native/unroll.h"
#include "isa/target.h"

#include <cstdint>

namespace ISA_NATIVE::reg {

// --- types
inline constexpr int lanes = 8;
struct F {
    float v[lanes];
};
struct I {
    std::int32_t v[lanes];
};
struct M {
    bool v[lanes];
};

template <class R, class Op> inline R each(Op op) {
    R r;
    for (int i = 0; i < lanes; ++i)
        r.v[i] = op(i);
    return r;
}
inline std::int32_t wrap(std::uint32_t x) { return static_cast<std::int32_t>(x); }
inline std::uint32_t word(std::int32_t x) { return static_cast<std::uint32_t>(x); }

inline F broadcast(float x) {
    return each<F>([&](int) { return x; });
}
inline I broadcast(std::int32_t x) {
    return each<I>([&](int) { return x; });
}
inline I iota() {
    return each<I>([](int i) { return i; });
}

// --- float arithmetic
inline F add(F a, F b) {
    return each<F>([&](int i) { return a.v[i] + b.v[i]; });
}
inline F sub(F a, F b) {
    return each<F>([&](int i) { return a.v[i] - b.v[i]; });
}
inline F mul(F a, F b) {
    return each<F>([&](int i) { return a.v[i] * b.v[i]; });
}
inline F div(F a, F b) {
    return each<F>([&](int i) { return a.v[i] / b.v[i]; });
}
inline F fma(F a, F b, F c) { // a*b + c, one rounding
    return each<F>([&](int i) { return __builtin_fmaf(a.v[i], b.v[i], c.v[i]); });
}
inline F fms(F a, F b, F c) { // a*b - c, one rounding
    return each<F>([&](int i) { return __builtin_fmaf(a.v[i], b.v[i], -c.v[i]); });
}
inline F fnma(F a, F b, F c) { // c - a*b, one rounding
    return each<F>([&](int i) { return __builtin_fmaf(-a.v[i], b.v[i], c.v[i]); });
}
inline F product_error(F a, F b, F p) { // a*b - p, exact where p is the rounded product
    return each<F>([&](int i) { return __builtin_fmaf(a.v[i], b.v[i], -p.v[i]); });
}
inline F min(F a, F b) { // a < b ? a : b
    return each<F>([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline F max(F a, F b) { // a > b ? a : b
    return each<F>([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline F sqrt(F a) {
    return each<F>([&](int i) { return __builtin_sqrtf(a.v[i]); });
}
inline F floor(F a) {
    return each<F>([&](int i) { return __builtin_floorf(a.v[i]); });
}
inline F round_even(F a) {
    return each<F>([&](int i) { return __builtin_rintf(a.v[i]); });
}

// --- float comparison
inline M lt(F a, F b) {
    return each<M>([&](int i) { return a.v[i] < b.v[i]; });
}
inline M le(F a, F b) {
    return each<M>([&](int i) { return a.v[i] <= b.v[i]; });
}
inline M eq(F a, F b) {
    return each<M>([&](int i) { return a.v[i] == b.v[i]; });
}
inline M ne(F a, F b) {
    return each<M>([&](int i) { return a.v[i] != b.v[i]; });
}
inline F select(M m, F a, F b) {
    return each<F>([&](int i) { return m.v[i] ? a.v[i] : b.v[i]; });
}

// --- integers (32-bit, wrapping)
inline I add(I a, I b) {
    return each<I>([&](int i) { return wrap(word(a.v[i]) + word(b.v[i])); });
}
inline I sub(I a, I b) {
    return each<I>([&](int i) { return wrap(word(a.v[i]) - word(b.v[i])); });
}
inline I mul(I a, I b) { // low 32 bits
    return each<I>([&](int i) { return wrap(word(a.v[i]) * word(b.v[i])); });
}
inline I bit_and(I a, I b) {
    return each<I>([&](int i) { return a.v[i] & b.v[i]; });
}
inline I bit_or(I a, I b) {
    return each<I>([&](int i) { return a.v[i] | b.v[i]; });
}
inline I bit_xor(I a, I b) {
    return each<I>([&](int i) { return a.v[i] ^ b.v[i]; });
}
// Shift counts are taken modulo 32 in each lane.
inline I shift_left(I a, I n) {
    return each<I>([&](int i) { return wrap(word(a.v[i]) << (word(n.v[i]) & 31U)); });
}
inline I shift_right(I a, I n) { // arithmetic
    return each<I>([&](int i) { return a.v[i] >> (word(n.v[i]) & 31U); });
}
inline I shift_right_logical(I a, I n) {
    return each<I>([&](int i) { return wrap(word(a.v[i]) >> (word(n.v[i]) & 31U)); });
}
// The same with one constant count, 0 to 31, for all lanes.
inline I shift_left(I a, int n) { return shift_left(a, broadcast(std::int32_t{n})); }
inline I shift_right(I a, int n) { return shift_right(a, broadcast(std::int32_t{n})); }
inline I shift_right_logical(I a, int n) { return shift_right_logical(a, broadcast(std::int32_t{n})); }
inline I min(I a, I b) {
    return each<I>([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
}
inline I max(I a, I b) {
    return each<I>([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}
inline M lt(I a, I b) {
    return each<M>([&](int i) { return a.v[i] < b.v[i]; });
}
inline M le(I a, I b) {
    return each<M>([&](int i) { return a.v[i] <= b.v[i]; });
}
inline M eq(I a, I b) {
    return each<M>([&](int i) { return a.v[i] == b.v[i]; });
}
inline M ne(I a, I b) {
    return each<M>([&](int i) { return a.v[i] != b.v[i]; });
}
inline I select(M m, I a, I b) {
    return each<I>([&](int i) { return m.v[i] ? a.v[i] : b.v[i]; });
}

// --- masks
inline M mask_and(M a, M b) {
    return each<M>([&](int i) { return a.v[i] && b.v[i]; });
}
inline M mask_or(M a, M b) {
    return each<M>([&](int i) { return a.v[i] || b.v[i]; });
}
inline M mask_xor(M a, M b) {
    return each<M>([&](int i) { return a.v[i] != b.v[i]; });
}
inline M mask_not(M a) {
    return each<M>([&](int i) { return !a.v[i]; });
}
inline std::uint32_t bits(M m) { // bit i = lane i
    std::uint32_t r = 0;
    for (int i = 0; i < lanes; ++i)
        r |= static_cast<std::uint32_t>(m.v[i]) << i;
    return r;
}
inline M from_bits(std::uint32_t b) { // bits above the lanes are ignored
    return each<M>([&](int i) { return ((b >> i) & 1U) != 0; });
}

// --- conversion
inline I to_int(F a) { // towards zero; NaN and what does not fit give INT_MIN
    return each<I>([&](int i) {
        float x = a.v[i];
        return x >= -2147483648.0F && x < 2147483648.0F ? static_cast<std::int32_t>(x) : (-0x7fffffff - 1);
    });
}
inline F to_float(I a) { // to nearest, ties to even
    return each<F>([&](int i) { return static_cast<float>(a.v[i]); });
}
inline I as_int(F a) {
    return each<I>([&](int i) { return __builtin_bit_cast(std::int32_t, a.v[i]); });
}
inline F as_float(I a) {
    return each<F>([&](int i) { return __builtin_bit_cast(float, a.v[i]); });
}

// --- memory. Addresses need only the alignment of one element; masked-off lanes are not accessed and load as
// 0.
inline F load(const float* p) {
    return each<F>([&](int i) { return p[i]; });
}
inline I load(const std::int32_t* p) {
    return each<I>([&](int i) { return p[i]; });
}
inline F load(const float* p, M m) {
    return each<F>([&](int i) { return m.v[i] ? p[i] : 0.0F; });
}
inline I load(const std::int32_t* p, M m) {
    return each<I>([&](int i) { return m.v[i] ? p[i] : 0; });
}
inline void store(float* p, F a) {
    for (int i = 0; i < lanes; ++i)
        p[i] = a.v[i];
}
inline void store(std::int32_t* p, I a) {
    for (int i = 0; i < lanes; ++i)
        p[i] = a.v[i];
}
inline void store(float* p, F a, M m) {
    for (int i = 0; i < lanes; ++i)
        if (m.v[i])
            p[i] = a.v[i];
}
inline void store(std::int32_t* p, I a, M m) {
    for (int i = 0; i < lanes; ++i)
        if (m.v[i])
            p[i] = a.v[i];
}
inline F gather(const float* p, I index, M m) {
    return each<F>([&](int i) { return m.v[i] ? p[index.v[i]] : 0.0F; });
}
inline I gather(const std::int32_t* p, I index, M m) {
    return each<I>([&](int i) { return m.v[i] ? p[index.v[i]] : 0; });
}
inline void scatter(float* p, I index, F a,
                    M m) { // lanes in ascending order: of equal indices the highest lane stays
    for (int i = 0; i < lanes; ++i)
        if (m.v[i])
            p[index.v[i]] = a.v[i];
}
inline void scatter(std::int32_t* p, I index, I a, M m) {
    for (int i = 0; i < lanes; ++i)
        if (m.v[i])
            p[index.v[i]] = a.v[i];
}

// --- within one register: fold lane i with lane i + n/2, n = lanes, lanes/2, ... 2
template <class R, class Op> inline auto fold(R a, Op op) {
    for (int n = lanes / 2; n >= 1; n /= 2)
        for (int i = 0; i < n; ++i)
            a.v[i] = op(a.v[i], a.v[i + n]);
    return a.v[0];
}
inline float reduce_add(F a) {
    return fold(a, [](float x, float y) { return x + y; });
}
inline float reduce_min(F a) {
    return fold(a, [](float x, float y) { return x < y ? x : y; });
}
inline float reduce_max(F a) {
    return fold(a, [](float x, float y) { return x > y ? x : y; });
}
inline std::int32_t reduce_add(I a) {
    return fold(a, [](std::int32_t x, std::int32_t y) { return wrap(word(x) + word(y)); });
}
inline std::int32_t reduce_min(I a) {
    return fold(a, [](std::int32_t x, std::int32_t y) { return x < y ? x : y; });
}
inline std::int32_t reduce_max(I a) {
    return fold(a, [](std::int32_t x, std::int32_t y) { return x > y ? x : y; });
}

} // namespace ISA_NATIVE::reg

#include "isa/native/through_memory.h"

namespace ISA_NATIVE::reg {

// --- across registers: arrays of n registers that make up one vector
template <int n> inline bool any(const M (&m)[n]) {
    std::uint32_t b = 0;
    for (int i = 0; i < n; ++i)
        b |= bits(m[i]);
    return b != 0;
}
template <int n> inline bool all(const M (&m)[n]) {
    std::uint32_t b = ~0U;
    for (int i = 0; i < n; ++i)
        b &= bits(m[i]);
    return b == (1U << lanes) - 1;
}
// Lane i of the result is lane index[i], modulo n * lanes, of a.
template <class R, int n> inline void permute(R (&to)[n], const R (&a)[n], const I (&index)[n]) {
    through_memory::permute(to, a, index);
}
// The lanes of a that m names, in order, from lane 0 on; the rest are 0.
template <class R, int n> inline void compress(R (&to)[n], const R (&a)[n], const M (&m)[n]) {
    through_memory::compress(to, a, m, [](R x, M k) {
        R r{};
        for (int i = 0, to_lane = 0; i < lanes; ++i)
            if (k.v[i])
                r.v[to_lane++] = x.v[i];
        return r;
    });
}
// One lane, modulo n * lanes.
template <class R, int n> inline auto extract(const R (&a)[n], int lane) { return through_memory::extract(a, lane); }

} // namespace ISA_NATIVE::reg
