// What files with one look each are made of: shading of their own, and nothing of what tracing rays takes,
// which kernels.cpp has. Compiled apart, looks do not depend on each other, nor does the code that the
// compiler makes of them.
#pragma once

#include "razor/kernels/worker.h"

namespace razor::ISA_TARGET {
inline namespace traverse_kernel {

extern template Hits trace<flat, false>(const Context& c, const Rays& r);
extern template Hits trace<flat, true>(const Context& c, const Rays& r);
extern template Hits trace<hanging, false>(const Context& c, const Rays& r);
extern template Hits trace<hanging, true>(const Context& c, const Rays& r);

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
