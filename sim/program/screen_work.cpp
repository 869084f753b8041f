#include "sim/program/screen_work.h"

#include "razor/frame/frame.h"
#include "razor/frame/phases.h"
#include "razor/native/render.h"
#include "razor/native/targets.h"

#include <algorithm>
#include <chrono>

namespace sim {
namespace {

double real(std::int64_t count) {
    return static_cast<double>(count);
}

bool is_built(std::size_t phase) {
    return phase == razor::phase_build || phase == razor::phase_tessellate;
}

/// Neighbouring screen tiles that lie in the stretches of one tree's workers.
struct Part {
    int tree = 0, first = 0, end = 0;
};

std::vector<Part> parts_of(int tiles, const std::vector<Seat>& seats) {
    const std::vector<int> first = stretches(tiles, static_cast<int>(seats.size()));
    std::vector<Part> out;
    for (std::size_t w = 0; w < seats.size(); ++w) {
        if (out.empty() || out.back().tree != seats[w].tree)
            out.push_back({seats[w].tree, first[w], first[w]});
        out.back().end = first[w + 1];
    }
    return out;
}

/// What each tile of the part counts where those behind it on the curve were rendered before.
std::vector<razor::Counters> counted_backward(razor::Frame& frame, const razor::KernelTable& kernels,
                                              const Part& part, const std::atomic<bool>& cancel) {
    frame.reset();
    for (int tile = part.end; tile-- > part.first;) {
        frame.take_tiles(tile, tile + 1);
        razor::run_workers(frame, kernels, {}, &cancel);
    }
    std::vector<razor::Counters> out;
    for (const razor::TileCost& tile : frame.tile_costs(kernels))
        out.push_back(tile.counters.sum());
    return out;
}

/// The part of a tree's builds that one of `tiles` does. Whoever comes first builds what several need: with
/// tiles in one order and the other, a tile's mean share nears that of all orders (the Shapley value). Half
/// of the work is spread evenly instead: who finds something being built turns to what nobody builds yet.
double share(const razor::Counters& forward, const razor::Counters& backward, const razor::Counters& tree,
             std::size_t tiles, std::size_t phase) {
    const auto count = [phase](const razor::Counters& c) {
        return real(phase == razor::phase_build ? c.patches_opened + c.blocks_made : c.vertices_made);
    };
    const double even = 1 / static_cast<double>(tiles), all = count(tree);
    return all > 0 ? 0.5 * even + 0.25 * (count(forward) + count(backward)) / all : even;
}

} // namespace

std::vector<double> drivers(const razor::Counters& c, double nodes) {
    std::vector<double> d(razor::phase_count, 1);
    d[razor::phase_build] = nodes;
    d[razor::phase_tessellate] = real(c.vertices_made);
    d[razor::phase_shade] = real(c.rays);
    d[razor::phase_traverse] = real(c.node_visits);
    d[razor::phase_intersect] = real(c.block_tests + c.cell_tests + c.quad_tests);
    d[razor::phase_morph] = real(c.blended_blocks);
    d[razor::phase_light] = real(c.rays);
    d[razor::phase_resolve] = real(c.packets);
    return d;
}

std::vector<bool> once_a_frame() {
    std::vector<bool> once(razor::phase_count);
    once[razor::phase_animate] = true;
    return once;
}

CountedScreen count_screen(const razor::Scene& scene, const std::vector<Seat>& seats, const Seed& seed,
                           const std::vector<double>& seed_drivers, const std::atomic<bool>& cancel) {
    const auto begin = std::chrono::steady_clock::now();
    CountedScreen out;
    ScreenWork& work = out.work;
    const auto instructions = [&](const std::vector<double>& counted) {
        PhaseWork w(razor::phase_count);
        for (std::size_t p = 0; p < w.size(); ++p)
            w[p] = seed_drivers[p] > 0 ? seed.phases[p].instructions * counted[p] / seed_drivers[p] : 0;
        return w;
    };
    work.once.assign(razor::phase_count, 0);
    work.once[razor::phase_animate] = seed.phases[razor::phase_animate].instructions;
    const razor::KernelTable& kernels = razor::native_target("auto");
    razor::Frame frame(scene, {.workers = 1, .tile_costs = true});
    for (const Part& part : parts_of(razor::screen_tiles(scene.settings), seats)) {
        if (part.first == part.end)
            continue;
        const std::vector<razor::Counters> backward = counted_backward(frame, kernels, part, cancel);
        frame.reset();
        frame.take_tiles(part.first, part.end);
        razor::run_workers(frame, kernels, {}, &cancel);
        const razor::FrameStatistics s = frame.statistics();
        const PhaseWork all = instructions(drivers(s.counters, real(s.inner_nodes)));
        const std::vector<razor::TileCost> forward = frame.tile_costs(kernels);
        for (std::size_t t = 0; t < forward.size(); ++t) {
            const razor::Counters counted = forward[t].counters.sum();
            PhaseWork own = instructions(drivers(counted, 0)), built(own.size());
            for (std::size_t p = 0; p < own.size(); ++p) {
                if (is_built(p))
                    built[p] = all[p] * share(counted, backward[t], s.counters, forward.size(), p);
                if (is_built(p) || p == razor::phase_animate)
                    own[p] = 0;
            }
            work.tiles.push_back(std::move(own));
            work.built.push_back(std::move(built));
        }
        out.rays += real(s.counters.rays);
        out.grid_bytes += real(s.grid_bytes);
        out.node_bytes += real(s.node_bytes);
        out.list_bytes += real(s.list_bytes);
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return out;
}

} // namespace sim
