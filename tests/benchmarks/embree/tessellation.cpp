#include "tests/benchmarks/embree/tessellation.h"

#include "isa/cpu.h"
#include "razor/scene/error.h"
#include "tests/benchmarks/embree/parallel.h"

#include <fmt/core.h>

#include <algorithm>

namespace razor::baseline {

const Kernels& choose_kernels(const std::string& isa) {
    std::vector<const Kernels*> there; // the best last
#ifdef RAZOR_HAS_PLAIN
    there.push_back(&plain::baseline_kernels);
#endif
#ifdef RAZOR_HAS_SSE4
    there.push_back(&sse4::baseline_kernels);
#endif
#ifdef RAZOR_HAS_AVX2
    there.push_back(&avx2::baseline_kernels);
#endif
#ifdef RAZOR_HAS_AVX512
    there.push_back(&avx512::baseline_kernels);
#endif
    const Kernels* chosen = nullptr;
    for (const Kernels* k : there)
        if (isa::cpu_runs(k->name) && (isa == "auto" || isa == k->name))
            chosen = k;
    if (chosen == nullptr)
        throw UserError(
            fmt::format("--isa {}: this build or processor has no such kernels; leave it out", isa));
    return *chosen;
}

void tessellate(const std::vector<Tessellation>& tessellations, const Kernels& kernels, int threads) {
    constexpr int at_once = 512; // blocks
    struct Task {
        const Tessellation* of;
        int first;
    };
    std::vector<Task> tasks;
    for (const Tessellation& t : tessellations)
        for (int first = 0; first < static_cast<int>(t.grid->blocks.size()); first += at_once)
            tasks.push_back({&t, first});
    share_out(threads, static_cast<int>(tasks.size()), [&](int n, int) {
        const auto& [of, first] = tasks[static_cast<std::size_t>(n)];
        const GridMesh& grid = *of->grid;
        const int count = std::min(at_once, static_cast<int>(grid.blocks.size()) - first);
        kernels.tessellate({grid.blocks.data() + first, count, grid.weights.data(), grid.controls.data(),
                            of->points, of->positions, of->normals});
    });
    share_out(threads, static_cast<int>(tessellations.size()), [&](int n, int) {
        const Tessellation& t = tessellations[static_cast<std::size_t>(n)];
        for (const GridMesh::Weld& w : t.grid->welds)
            std::copy_n(t.positions + 3 * w.from, 3, t.positions + 3 * w.to);
    });
}

} // namespace razor::baseline
