#include "razor/check/escapes.h"

#include "razor/check/field_surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>

namespace razor::check {

namespace {

constexpr int capacity = 8192; // rays traced at once
constexpr int tries_an_origin = 2000;
constexpr int patches_an_origin = 24; // that rays are aimed at
constexpr int rays_a_patch = 64;      // one after the other: as coherent as a camera's
constexpr std::size_t bad_rays_kept = 3;

class Shooting {
public:
    Shooting(Frame& frame, const KernelTable& kernels, Lod lod, const EscapeOptions& options)
        : kernels_(kernels), lod_(lod), options_(options), tracer_(frame, capacity, 1), unit_(frame.unit()),
          random_(options.seed) {
        frame.build_all(kernels);
        surface_ = std::make_unique<FieldSurface>(frame);
        const bool one = lod == Lod::recursive || one_level(lod);
        const int last = one ? surface_->finest_level() : surface_->coarsest_level();
        for (int level = surface_->finest_level(); level <= last; ++level) {
            // At 2^level all that is born below it is gone, and nothing else moves.
            Ray whole;
            whole.base = static_cast<float>(std::ldexp(1.0, level));
            levels_.emplace_back(*surface_, whole);
        }
        edge_ = std::ldexp(1.0, surface_->finest_level());
        report_.patches = static_cast<std::int64_t>(surface_->patches());
        report_.vertices = static_cast<std::int64_t>(surface_->vertices());
    }

    EscapeReport run() {
        while (report_.rays < options_.rays && !report_.cancelled) {
            std::vector<Start> starts = find_starts();
            if (starts.empty())
                break;
            trace(starts);
            if (options_.progress)
                options_.progress(static_cast<double>(report_.rays) / static_cast<double>(options_.rays));
            report_.cancelled = options_.cancel != nullptr && options_.cancel->load();
        }
        return report_;
    }

private:
    /// An origin and what is asked for there.
    struct Start {
        Ray ray;
        std::unique_ptr<SeenSurface> seen;
        std::vector<std::uint32_t> aims; // patches
    };

    std::uint32_t bits() { return static_cast<std::uint32_t>(random_()); }
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits() >> 8) / 16777216.0;
    }
    Point direction() {
        for (;;) {
            const glm::dvec3 d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            const double square = glm::dot(d, d);
            if (square <= 1 && square > 0.01)
                return to_point(d / std::sqrt(square));
        }
    }
    static Point to_point(const glm::dvec3& p) {
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }

    void ask(Ray& ray) {
        constexpr double growths[] = {-1, -0.1, -0.01, 0, 0, 0.001, 0.01, 0.05, 0.25, 1, 10};
        const double cap = gradation_cap;
        const double growth = options_.growth ? *options_.growth : growths[bits() % std::size(growths)];
        const double octaves = surface_->coarsest_level() - surface_->finest_level();
        const double base =
            std::exp2(options_.base ? std::log2(*options_.base) + uniform(-0.5, 0.5) : uniform(-1, octaves));
        ray.growth = static_cast<float>(std::clamp(growth, -cap, cap));
        ray.base = std::max(static_cast<float>(edge_ * base), least_target_edge);
        if (bits() % 4 == 0) { // through a lens
            const double slope = cap * uniform(0, 1);
            const Point axis = direction();
            for (std::size_t k = 0; k < 3; ++k)
                ray.slope[k] = static_cast<float>(slope * axis[k]);
            ray.growth = static_cast<float>(std::clamp(growth, slope - cap, cap - slope));
        }
        if (one_level(lod_)) {
            ray.growth = 0;
            ray.slope = {};
            ray.base = least_target_edge;
        }
    }

    /// An origin inside, or nothing after many tries.
    std::optional<Start> find_start() {
        const Extent& all = surface_->extent();
        for (int i = 0; i < tries_an_origin; ++i) {
            // Half of them just under the surface, where bodies are thin.
            Ray ray;
            if (i % 2 == 0) {
                ray.origin = to_point(all.low + (all.high - all.low) *
                                                    glm::dvec3(uniform(0, 1), uniform(0, 1), uniform(0, 1)));
            } else {
                const glm::dvec3 p = levels_.front().feature(bits(), bits(), 0);
                const Point way = direction();
                const double off = edge_ * std::exp2(uniform(-2, 6));
                ray.origin = to_point(p + off * glm::dvec3(way[0], way[1], way[2]));
            }
            ask(ray);
            Start start{ray, std::make_unique<SeenSurface>(*surface_, ray), {}};
            if (!start.seen->inside(ray.origin) || !inside_every_level(ray.origin))
                continue;
            for (int k = 0; k < patches_an_origin; ++k)
                start.aims.push_back(bits());
            return start;
        }
        return {};
    }
    /// Of schemes that have no one surface.
    bool inside_every_level(const Point& p) {
        return levels_.size() == 1 ||
               std::all_of(levels_.begin(), levels_.end(), [&](SeenSurface& s) { return s.inside(p); });
    }

    std::vector<Start> find_starts() {
        const std::int64_t left = options_.rays - report_.rays;
        const int each = std::clamp(options_.rays_an_origin, 1, capacity);
        std::vector<Start> starts;
        for (std::int64_t n = 0; n < left && n + each <= capacity; n += each) {
            std::optional<Start> start = find_start();
            if (!start)
                break;
            starts.push_back(std::move(*start));
        }
        report_.origins += static_cast<std::int64_t>(starts.size());
        return starts;
    }

    /// Anywhere, or to vertices and edges of one patch.
    Point aim(Start& start, std::optional<std::uint32_t> patch) {
        if (!patch)
            return direction();
        const double along = bits() % 2 == 0 ? 0 : uniform(0, 1);
        const glm::dvec3 to = start.seen->feature(*patch, bits(), along);
        const glm::dvec3 from(start.ray.origin[0], start.ray.origin[1], start.ray.origin[2]);
        const double length = glm::length(to - from);
        return length > 0 ? to_point((to - from) / length) : direction();
    }

    void trace(std::vector<Start>& starts) {
        const int each = std::clamp(options_.rays_an_origin, 1, capacity);
        std::vector<Ray> rays;
        std::vector<std::size_t> of; // number of each one's start
        std::optional<std::uint32_t> patch;
        for (std::size_t s = 0; s < starts.size(); ++s)
            for (int i = 0; i < each; ++i) {
                if (i % rays_a_patch == 0) {
                    patch = starts[s].aims[bits() % starts[s].aims.size()];
                    if (bits() % 8 == 0)
                        patch.reset();
                }
                Ray ray = starts[s].ray;
                ray.direction = aim(starts[s], patch);
                rays.push_back(ray);
                of.push_back(s);
            }
        // Most packets have one field, as a camera's do; in the rest fields are mixed.
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (i / 64 % 8 == 0) {
                const std::size_t j = bits() % rays.size();
                std::swap(rays[i], rays[j]);
                std::swap(of[i], of[j]);
            }
        const auto begin = std::chrono::steady_clock::now();
        const std::vector<Hit> hits = tracer_.closest(kernels_, rays);
        report_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ++report_.rays;
            if (hits[i].patch < 0) {
                ++report_.escapes;
                const auto found = starts[of[i]].seen->crossings(rays[i], 0);
                report_.holes += found.empty() ? 1 : 0;
                keep({rays[i], -1, found.empty() ? -1 : found.front().t}, report_.escaped);
            } else if (compares()) {
                compare(*starts[of[i]].seen, rays[i], hits[i]);
            }
        }
    }

    bool compares() const {
        return sees_one_surface(lod_) &&
               // Spread evenly over all rays.
               report_.compared * options_.rays < options_.compared * report_.rays;
    }
    void compare(SeenSurface& seen, const Ray& ray, const Hit& hit) {
        ++report_.compared;
        const auto possible = seen.crossings(ray, hit_roundings);
        double best = 1e300;
        for (const auto& c : possible)
            best = std::min(best, std::abs(c.t - hit.t) / c.slack);
        bool right = best <= 1;
        if (right) {
            report_.worst = std::max(report_.worst, best);
            // Nothing that is certainly there lies before it.
            const auto certain = seen.crossings(ray, -hit_roundings);
            right = certain.empty() || hit.t <= certain.front().t + certain.front().slack;
        }
        if (right)
            return;
        ++report_.different;
        const auto found = seen.crossings(ray, 0);
        keep({ray, hit.t, found.empty() ? -1 : found.front().t}, report_.differing);
    }
    /// In world units.
    void keep(BadRay bad, std::vector<BadRay>& rays) const {
        if (rays.size() >= bad_rays_kept)
            return;
        const auto unit = static_cast<float>(unit_);
        for (float& x : bad.ray.origin)
            x *= unit;
        bad.ray.base *= unit;
        bad.t *= bad.t < 0 ? 1 : unit;
        bad.expected *= bad.expected < 0 ? 1 : unit_;
        rays.push_back(bad);
    }

    const KernelTable& kernels_;
    Lod lod_;
    EscapeOptions options_;
    Tracer tracer_;
    double unit_;
    std::unique_ptr<FieldSurface> surface_;
    std::vector<SeenSurface> levels_;
    double edge_ = 1; // finest
    std::mt19937 random_;
    EscapeReport report_;
};

} // namespace

EscapeReport shoot_from_inside(Frame& frame, const KernelTable& kernels, Lod lod,
                               const EscapeOptions& options) {
    return Shooting(frame, kernels, lod, options).run();
}

} // namespace razor::check
