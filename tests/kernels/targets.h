// The targets of this build that this processor can run, for tests.
#pragma once

#include "razor/native/targets.h"

#include <algorithm>
#include <cstring>
#include <utility>
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

/// Of things that have a target's name, those of these targets.
template <class Named>
std::vector<Named> of_targets(std::vector<Named> all, const std::vector<const KernelTable*>& targets) {
    std::erase_if(all, [&](const Named& one) {
        return std::none_of(targets.begin(), targets.end(),
                            [&](const KernelTable* k) { return std::strcmp(k->name, one.name) == 0; });
    });
    return all;
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
