// The kernels of scenes in which something reflects, lets through or emits: what shading them takes, and
// nothing of what tracing rays does.
#include "razor/kernels/path.h"
#include "razor/kernels/worker.h"

namespace razor::ISA_TARGET {

inline namespace traverse_kernel {
extern template Hits trace<flat, false>(const Context& c, const Rays& r);
extern template Hits trace<flat, true>(const Context& c, const Rays& r);
extern template Hits trace<hanging, false>(const Context& c, const Rays& r);
extern template Hits trace<hanging, true>(const Context& c, const Rays& r);
} // namespace traverse_kernel

template <Features F> void render_glossy(const WorkerArguments& a) {
    render<F, PathSampler>(a);
}
template void render_glossy<flat>(const WorkerArguments& a);
template void render_glossy<hanging>(const WorkerArguments& a);

} // namespace razor::ISA_TARGET
