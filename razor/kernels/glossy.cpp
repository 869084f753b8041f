// The kernels of scenes in which something reflects, lets through or emits.
#include "razor/kernels/apart.h"
#include "razor/kernels/path.h"

namespace razor::ISA_TARGET {

template <Features F> void render_glossy(const WorkerArguments& a) {
    render<F, PathSampler<false>>(a);
}
template void render_glossy<flat>(const WorkerArguments& a);
template void render_glossy<hanging>(const WorkerArguments& a);

} // namespace razor::ISA_TARGET
