// The kernels of scenes of matte surfaces with textures or materials of faces, and what sees any scene
// past what textures cut out.
#include "razor/kernels/apart.h"
#include "razor/kernels/matte.h"
#include "razor/kernels/see.h"

namespace razor::ISA_TARGET {

template <Features F> void render_mapped(const WorkerArguments& a) {
    render<F, MatteSampler<true>>(a);
}
template void render_mapped<flat>(const WorkerArguments& a);
template void render_mapped<hanging>(const WorkerArguments& a);

template <Features F> void see_mapped(const WorkerArguments& a, const SeeArguments& l) {
    see<F, true>(begin(a), l);
}
template void see_mapped<flat>(const WorkerArguments& a, const SeeArguments& l);
template void see_mapped<hanging>(const WorkerArguments& a, const SeeArguments& l);

} // namespace razor::ISA_TARGET
