// The kernels of scenes in which something reflects, lets through or emits, with textures or materials of
// faces.
#include "razor/kernels/apart.h"
#include "razor/kernels/path.h"

namespace razor::ISA_TARGET {

template <Features F> void render_glossy_mapped(const WorkerArguments& a) {
    render<F, PathSampler<true>>(a);
}
template void render_glossy_mapped<flat>(const WorkerArguments& a);
template void render_glossy_mapped<hanging>(const WorkerArguments& a);

} // namespace razor::ISA_TARGET
