#include "sim/program/screen_work.h"

#include "razor/frame/frame.h"
#include "razor/frame/phases.h"
#include "razor/native/render.h"
#include "razor/native/targets.h"
#include "sim/estimate/screen_schedule.h"

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

double need(const ScreenNeed& n, std::size_t phase) {
    return phase == razor::phase_build ? n.nodes : n.surfaces;
}

/// The part of its tree's builds that each screen tile of the part does: by what it needs. What several need
/// is built by whoever comes first, most likely by one that is long at it.
std::vector<double> build_shares(const std::vector<ScreenNeed>& needs, const Part& part, std::size_t phase) {
    std::vector<double> out;
    double all = 0;
    for (int t = part.first; t < part.end; ++t) {
        out.push_back(need(needs[static_cast<std::size_t>(t)], phase));
        all += out.back();
    }
    for (double& share : out)
        share = all > 0 ? share / all : 1 / static_cast<double>(out.size());
    return out;
}

} // namespace

std::vector<double> drivers(const razor::Counters& c, double nodes) {
    std::vector<double> d(razor::phase_count, 1);
    d[razor::phase_build] = nodes;
    // A block takes what its patch does to evaluate, and vectors of its points.
    d[razor::phase_tessellate] = real(c.patches_opened + c.blocks_made) + real(c.vertices_made) / ISA_WIDTH;
    d[razor::phase_shade] = real(c.rays);
    d[razor::phase_traverse] = real(c.node_visits);
    d[razor::phase_intersect] = real(c.block_tests + c.cell_tests + c.quad_tests);
    d[razor::phase_morph] = real(c.blended_blocks);
    d[razor::phase_light] = real(c.rays);
    d[razor::phase_resolve] = real(c.packets);
    return d;
}

std::vector<PhaseUse> uses_of_phases() {
    std::vector<PhaseUse> uses(razor::phase_count, PhaseUse::renders);
    uses[razor::phase_animate] = PhaseUse::once;
    for (std::size_t p = 0; p < uses.size(); ++p)
        if (is_built(p))
            uses[p] = PhaseUse::builds;
    return uses;
}

std::vector<ScreenNeed> count_needs(const razor::Scene& scene, const std::atomic<bool>& cancel) {
    const razor::KernelTable& kernels = razor::native_target("auto");
    razor::Frame frame(scene, {.workers = 1});
    std::vector<ScreenNeed> out;
    for (int tile = 0; tile < razor::screen_tiles(scene.settings); ++tile) {
        frame.reset();
        frame.take_tiles(tile, tile + 1);
        razor::run_workers(frame, kernels, {}, &cancel);
        const razor::FrameStatistics s = frame.statistics();
        const std::vector<double> d = drivers(s.counters, real(s.inner_nodes));
        out.push_back({d[razor::phase_build], d[razor::phase_tessellate]});
    }
    return out;
}

CountedScreen count_screen(const razor::Scene& scene, const std::vector<Seat>& seats, const Seed& seed,
                           const std::vector<double>& seed_drivers, const std::vector<ScreenNeed>& needs,
                           const std::atomic<bool>& cancel) {
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
        frame.reset();
        frame.take_tiles(part.first, part.end);
        razor::run_workers(frame, kernels, {}, &cancel);
        const razor::FrameStatistics s = frame.statistics();
        const PhaseWork all = instructions(drivers(s.counters, real(s.inner_nodes)));
        const std::size_t first = work.tiles.size();
        for (const razor::TileCost& tile : frame.tile_costs(kernels)) {
            work.tiles.push_back(instructions(drivers(tile.counters.sum(), 0)));
            work.built.emplace_back(razor::phase_count);
        }
        for (std::size_t p = 0; p < razor::phase_count; ++p) {
            const std::vector<double> shares = build_shares(needs, part, p);
            for (std::size_t t = 0; t < shares.size(); ++t) {
                if (is_built(p))
                    work.built[first + t][p] = all[p] * shares[t];
                if (is_built(p) || p == razor::phase_animate)
                    work.tiles[first + t][p] = 0;
            }
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
