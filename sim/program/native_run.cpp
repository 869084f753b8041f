#include "sim/program/native_run.h"

#include "razor/native/render.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstring>

namespace sim {
namespace {

bool same_bits(const razor::Film& a, const razor::Film& b) {
    if (a.width != b.width || a.height != b.height || a.planes.size() != b.planes.size())
        return false;
    for (const razor::Plane& p : a.planes) {
        const razor::Plane* q = b.find(p.name);
        if (q == nullptr || p.values.size() != q->values.size() ||
            std::memcmp(p.values.data(), q->values.data(), p.values.size() * sizeof(float)) != 0)
            return false;
    }
    return true;
}

} // namespace

NativeRun run_native(const razor::Scene& scene, const razor::Film& simulated, const std::atomic<bool>& cancel,
                     int tiles, bool in_rows) {
    razor::RenderOptions options;
    options.tiles = tiles;
    options.tiles_in_rows = in_rows;
    options.threads = 1;
    options.cancel = &cancel;
    const razor::RenderResult result = razor::render_native(scene, options);
    NativeRun run;
    run.isa = result.statistics.isa;
    run.seconds = result.statistics.times.back().render_seconds;
    run.equal = same_bits(simulated, result.film);
    run.unfused = run.isa == "sse4";
    return run;
}

std::string native_text(const NativeRun& n, double simulated_seconds) {
    const char* picture = n.equal     ? "the same picture, bit for bit"
                          : n.unfused ? "the picture differs in last bits, as sse4 does not fuse"
                                      : "the picture DIFFERS";
    return fmt::format("native: {:.3f} s on one thread with {}, {:.0f} times faster; {}\n", n.seconds, n.isa,
                       n.slowdown(simulated_seconds), picture);
}

nlohmann::ordered_json native_json(const NativeRun& n, double simulated_seconds) {
    return {{"isa", n.isa},
            {"seconds", n.seconds},
            {"slowdown", n.slowdown(simulated_seconds)},
            {"picture_equal", n.equal}};
}

} // namespace sim
