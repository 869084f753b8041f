#include "razor/native/targets.h"

#include "razor/scene/error.h"

#include <fmt/core.h>

namespace razor {

std::vector<const KernelTable*> native_targets() {
    std::vector<const KernelTable*> t;
    __builtin_cpu_init();
#ifdef RAZOR_HAS_PLAIN
    t.push_back(&plain::kernels);
#endif
#ifdef RAZOR_HAS_SSE4
    if (__builtin_cpu_supports("sse4.2"))
        t.push_back(&sse4::kernels);
#endif
#ifdef RAZOR_HAS_AVX2
    bool avx2 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    if (avx2)
        t.push_back(&avx2::kernels);
#endif
#ifdef RAZOR_HAS_AVX512
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512cd"))
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
