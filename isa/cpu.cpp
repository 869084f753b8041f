#include "isa/cpu.h"

namespace isa {

bool cpu_runs(std::string_view target) {
    __builtin_cpu_init();
    if (target == "simulated")
        return cpu_runs(ISA_SIMULATED_VALUES);
    if (target == "sse4")
        return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
    bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                __builtin_cpu_supports("bmi2");
    if (target == "avx2")
        return avx2;
    if (target == "avx512")
        return avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512cd");
    return target == "plain";
}

} // namespace isa
