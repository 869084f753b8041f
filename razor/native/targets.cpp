#include "razor/native/targets.h"

#include "isa/cpu.h"
#include "razor/scene/error.h"

#include <fmt/core.h>

namespace razor {

std::vector<const KernelTable*> native_targets() {
    std::vector<const KernelTable*> t;
#ifdef RAZOR_HAS_PLAIN
    t.push_back(&plain::kernels);
#endif
#ifdef RAZOR_HAS_SSE4
    if (isa::cpu_runs("sse4"))
        t.push_back(&sse4::kernels);
#endif
#ifdef RAZOR_HAS_AVX2
    if (isa::cpu_runs("avx2"))
        t.push_back(&avx2::kernels);
#endif
#ifdef RAZOR_HAS_AVX512
    if (isa::cpu_runs("avx512"))
        t.push_back(&avx512::kernels);
#endif
    return t;
}

const KernelTable& native_target(const std::string& name) {
    std::vector<const KernelTable*> targets = native_targets();
    std::string choices = "auto";
    for (const KernelTable* t : targets) {
        if (name == t->name)
            return *t;
        choices += fmt::format(", {}", t->name);
    }
    if (name == "auto" && !targets.empty())
        return *targets.back();
    throw UserError(fmt::format("--isa {}: this build on this processor has {}", name, choices));
}

} // namespace razor
