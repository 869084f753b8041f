// Loops over registers, unrolled by the language: g++ keeps an array of registers in registers only if no loop over it
// is left when it looks for scalars, which at -O1 is always and at -O2 often.
#pragma once

#include "isa/target.h"

#include <utility>

namespace ISA_NATIVE {

/// f(0), f(1), ... f(n - 1).
template <int n, class F> [[gnu::always_inline]] inline void unroll(F f) {
    [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) { (f(i), ...); }
    (std::make_integer_sequence<int, n>());
}

} // namespace ISA_NATIVE
