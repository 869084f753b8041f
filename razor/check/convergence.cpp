#include "razor/check/convergence.h"

#include "razor/check/dump.h"
#include "razor/check/field_surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace razor::check {
namespace {

constexpr double finer = 16;                          // than the scene asks for
constexpr int coarsest_octave = 7, finest_octave = 3; // above the finest edges
constexpr std::int64_t least_hits = 32;               // for a median
// Rays traced between two looks at what cancels: whole packets of any width, so that no hit depends on it. At
// the limit one ray may dice for some milliseconds.
constexpr int slice = 64;

bool curved(const PatchRecord& patch) {
    return patch.kind < PatchKind::flat_quad;
}

/// The box of all instances that have curved patches, and the longest of their finest edges.
struct Target {
    Extent box;
    double edge = 0;
};
Target curved_part(Frame& frame) {
    const FrameHeader& h = frame.header();
    Target target;
    for (int n = 0; n < h.graph_count; ++n) {
        const GraphNodeRecord& node = h.graph.get()[n];
        if (node.instance < 0)
            continue;
        const InstanceRecord& instance = h.instances.get()[node.instance];
        bool any = false;
        for (int p = 0; p < instance.patch_count && !any; ++p)
            any = curved(patch_record(frame, instance.first_patch + p));
        if (!any)
            continue;
        target.box.add(glm::dvec3(node.low[0], node.low[1], node.low[2]));
        target.box.add(glm::dvec3(node.high[0], node.high[1], node.high[2]));
        target.edge = std::max(target.edge, static_cast<double>(instance.edge_length));
    }
    return target;
}

Point to_point(const glm::dvec3& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// From a sphere about the box to points in it.
std::vector<Ray> random_rays(const Extent& box, const ConvergenceOptions& options) {
    std::mt19937 random(options.seed);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(random() >> 8) / 16777216.0);
    };
    const auto within = [&](const glm::dvec3& low, const glm::dvec3& high) {
        const double x = uniform(low.x, high.x);
        const double y = uniform(low.y, high.y);
        return glm::dvec3(x, y, uniform(low.z, high.z));
    };
    const glm::dvec3 centre = 0.5 * (box.low + box.high);
    const double radius = 0.75 * glm::length(box.high - box.low);
    std::vector<Ray> rays;
    while (rays.size() < static_cast<std::size_t>(options.rays)) {
        const glm::dvec3 way = within(glm::dvec3(-1), glm::dvec3(1));
        if (glm::length(way) > 1 || glm::length(way) < 0.1)
            continue;
        const glm::dvec3 from = centre + radius * glm::normalize(way);
        Ray ray;
        ray.origin = to_point(from);
        ray.direction = to_point(glm::normalize(within(box.low, box.high) - from));
        rays.push_back(ray);
    }
    return rays;
}

/// Of log2(error) over log2(edge).
double slope_of(const std::vector<ConvergenceReport::Step>& steps) {
    const auto n = static_cast<double>(steps.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& s : steps) {
        if (s.hits < least_hits || !(s.median_error > 0))
            return 0;
        const double a = std::log2(s.edge), b = std::log2(s.median_error);
        x += a / n;
        y += b / n;
        xx += a * a;
        xy += a * b;
    }
    return (xy - n * x * y) / (xx - n * x * x);
}

} // namespace

ConvergenceReport measure_convergence(Scene scene, const KernelTable& kernels,
                                      const ConvergenceOptions& options) {
    scene.settings.lod = Lod::recursive;
    scene.settings.edge_pixels /= finer;
    for (Mesh& mesh : scene.meshes)
        mesh.edge_length /= finer;
    for (Material& material : scene.materials)
        material.two_sided = true; // rays come from anywhere
    Frame frame(scene, {});
    Tracer tracer(frame, slice);
    const Target target = curved_part(frame);
    ConvergenceReport report;
    if (target.edge == 0)
        return report;
    std::vector<Ray> rays = random_rays(target.box, options);
    // As far as it comes before that is cancelled.
    const auto traced = [&](double base) {
        for (Ray& r : rays)
            r.base = static_cast<float>(base);
        std::vector<Hit> hits;
        for (auto at = rays.begin(); at != rays.end();) {
            report.cancelled = options.cancel != nullptr && options.cancel->load();
            if (report.cancelled)
                break;
            const auto end = at + std::min<std::ptrdiff_t>(slice, rays.end() - at);
            const std::vector<Hit> some = tracer.closest(kernels, {at, end});
            hits.insert(hits.end(), some.begin(), some.end());
            at = end;
        }
        return hits;
    };
    const std::vector<Hit> limit = traced(least_target_edge);
    const auto known = [&](const Hit& h) { return h.patch >= 0 && curved(patch_record(frame, h.patch)); };
    for (int octave = coarsest_octave; octave >= finest_octave; --octave) {
        ConvergenceReport::Step step;
        const double edge = std::ldexp(target.edge, octave);
        step.edge = frame.unit() * edge;
        const std::vector<Hit> hits = traced(edge);
        if (report.cancelled)
            return report;
        std::vector<double> errors;
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (known(hits[i]) && known(limit[i]))
                errors.push_back(std::abs(double{hits[i].t} - double{limit[i].t}));
        step.hits = static_cast<std::int64_t>(errors.size());
        if (!errors.empty()) {
            const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
            std::nth_element(errors.begin(), middle, errors.end());
            step.median_error = frame.unit() * *middle;
        }
        report.steps.push_back(step);
        if (options.progress)
            options.progress((coarsest_octave + 1.0 - octave) / (coarsest_octave + 1 - finest_octave));
    }
    report.order = slope_of(report.steps);
    return report;
}

} // namespace razor::check
