// The kernels of scenes of matte surfaces with textures or materials of faces.
#include "razor/kernels/apart.h"
#include "razor/kernels/matte.h"

namespace razor::ISA_TARGET {

template <Features F> void render_mapped(const WorkerArguments& a) {
    render<F, MatteSampler<true>>(a);
}
template void render_mapped<flat>(const WorkerArguments& a);
template void render_mapped<hanging>(const WorkerArguments& a);

} // namespace razor::ISA_TARGET
