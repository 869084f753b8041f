// The targets of this build that this processor can run, for tests.
#pragma once

#include "razor/native/targets.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace razor::check {}

namespace razor::test {

using namespace check;

/// All native targets, and `simulated` where it is built: it runs here on a timing port that keeps no time.
inline std::vector<const KernelTable*> all_targets() {
    std::vector<const KernelTable*> targets = native_targets();
#ifdef RAZOR_HAS_SIMULATED
    targets.push_back(&simulated::kernels);
#endif
    return targets;
}

/// The best one alone, for what is compared within noise: others have its bits (tests/materials/targets.cpp),
/// or, sse4, nearly so.
inline std::vector<const KernelTable*> best_target() {
    return {native_targets().back()};
}

/// A test's own function of kernels, compiled for a target.
template <class Arrays> struct TargetFunction {
    const char* name;
    void (*run)(const Arrays&);
};
/// Those that this processor runs.
template <class Arrays>
std::vector<TargetFunction<Arrays>> runnable(std::vector<TargetFunction<Arrays>> functions) {
    const std::vector<const KernelTable*> runs = native_targets();
    std::erase_if(functions, [&](const TargetFunction<Arrays>& f) {
        return std::none_of(runs.begin(), runs.end(),
                            [&](const KernelTable* k) { return std::strcmp(k->name, f.name) == 0; });
    });
    return functions;
}

/// Those whose fused multiply-add rounds once, or those whose does not.
inline std::vector<const KernelTable*> targets_with(bool fused) {
    std::vector<const KernelTable*> targets;
    for (const KernelTable* t : all_targets())
        if ((std::strcmp(t->name, "sse4") != 0) == fused)
            targets.push_back(t);
    return targets;
}

} // namespace razor::test
