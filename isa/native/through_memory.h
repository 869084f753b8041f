// Operations across the registers of one vector by way of memory: what a target does that knows nothing
// better. Included by each registers_*.h once its own functions are declared.
#pragma once

#include "isa/native/unroll.h"

#include <cstdint>
#include <type_traits>

namespace ISA_NATIVE::reg::through_memory {

float element(F);
std::int32_t element(I);
template <class R> using element_of = decltype(element(R()));

template <class R> inline R as_register(I a) {
    if constexpr (std::is_same_v<element_of<R>, float>)
        return as_float(a);
    else
        return a;
}

template <class R, int n> struct spread {
    alignas(64) element_of<R> v[n * lanes];
    explicit spread(const R (&a)[n]) {
        unroll<n>([&](int i) { store(v + i * lanes, a[i]); });
    }
};
template <class R, int n> inline void permute(R (&to)[n], const R (&a)[n], const I (&index)[n]) {
    spread<R, n> from(a);
    M every = from_bits(~0U);
    unroll<n>([&](int i) { to[i] = gather(from.v, bit_and(index[i], broadcast(std::int32_t{n * lanes - 1})), every); });
}
/// `compress_1(a, m)` packs one register; its lanes beyond the count of m may hold anything.
template <class R, int n, class Op> inline void compress(R (&to)[n], const R (&a)[n], const M (&m)[n], Op compress_1) {
    alignas(64) element_of<R> v[(n + 1) * lanes];
    int count = 0;
    unroll<n>([&](int i) {
        store(v + count, compress_1(a[i], m[i]));
        count += __builtin_popcount(bits(m[i]));
    });
    unroll<n>([&](int i) {
        M used = lt(iota(), broadcast(std::int32_t{count - i * lanes}));
        to[i] = select(used, load(v + i * lanes), as_register<R>(broadcast(0)));
    });
}
template <class R, int n> inline element_of<R> extract(const R (&a)[n], int lane) {
    return spread<R, n>(a).v[lane & (n * lanes - 1)];
}

} // namespace ISA_NATIVE::reg::through_memory
