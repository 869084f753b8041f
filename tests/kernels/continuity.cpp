// What a ray hits moves continuously as its footprint grows, but where a fold of the surface comes or goes;
// and a camera that comes nearer sees no jumps. The discrete levels do jump: the checks see it.
#include "razor/check/field_surface.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include "razor/native/render.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

struct Jumps {
    long steps = 0;
    long pops = 0;  // with as many crossings before as after
    long folds = 0; // others
};

class Path {
public:
    Path(Lod lod, const std::string& scene)
        : scene_(named_scene(scene)->scene), frame_(with(scene_, lod), {}), tracer_(frame_, 64),
          target_(*native_targets().back()) {
        frame_.build_all(target_);
        surface_.emplace(frame_);
        edge_ = std::ldexp(1.0, surface_->finest_level());
    }

    Jumps jumps(float growth, int octaves, int steps_an_octave) {
        const Oracle oracle(frame_, true);
        RayMaker make(oracle.triangles(), oracle.origins(), 31);
        std::vector<Ray> rays;
        while (rays.size() < 48) {
            Ray r = make.random_ray();
            r.direction = beside(make.direction_at_feature(r.origin), make.random_direction());
            r.growth = growth;
            rays.push_back(r);
        }
        Jumps found;
        std::vector<double> before = at(rays, -1);
        for (int step = 1; step <= octaves * steps_an_octave; ++step) {
            const double x = -1 + static_cast<double>(step) / steps_an_octave;
            const std::vector<double> after = at(rays, x);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ++found.steps;
                if (!near(before[i], after[i]))
                    follow(rays[i], x - 1.0 / steps_an_octave, before[i], x, after[i], found);
            }
            before = after;
        }
        return found;
    }

private:
    static Scene& with(Scene& scene, Lod lod) {
        scene.settings.lod = lod;
        return scene;
    }
    /// Not through a vertex or edge: there single precision may decide otherwise than double.
    static Point beside(const Point& d, const Point& e) {
        const glm::dvec3 v =
            glm::normalize(glm::dvec3(d[0], d[1], d[2]) + 0.01 * glm::dvec3(e[0], e[1], e[2]));
        return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    }
    void ask(Ray& ray, double x) const { ray.base = static_cast<float>(edge_ * std::exp2(x)); }
    /// Distances of the hits at a target edge of 2^x finest ones; -1: none.
    std::vector<double> at(std::vector<Ray> rays, double x) {
        for (Ray& r : rays)
            ask(r, x);
        std::vector<double> t;
        for (const Hit& h : tracer_.closest(target_, rays))
            t.push_back(h.patch < 0 ? -1 : h.t);
        return t;
    }
    bool near(double a, double b) const { return (a < 0) == (b < 0) && std::abs(a - b) <= 0.02 * edge_; }
    std::size_t crossings(Ray ray, double x) const {
        ask(ray, x);
        return SeenSurface(*surface_, ray).crossings(ray, 0).size();
    }
    /// Halves a step in which the ray jumps, down to what single precision tells apart.
    void follow(const Ray& ray, double x, double before, double y, double after, Jumps& found) {
        while (y - x > 2e-6) {
            const double middle = 0.5 * (x + y);
            const double t = at({ray}, middle).front();
            if (!near(before, t)) {
                y = middle;
                after = t;
            } else if (!near(t, after)) {
                x = middle;
                before = t;
            } else {
                return;
            }
        }
        // Single precision may see a fold come a little sooner or later.
        constexpr double around = 2e-4;
        ++(crossings(ray, x - around) == crossings(ray, y + around) ? found.pops : found.folds);
    }

    Scene scene_;
    Frame frame_;
    Tracer tracer_;
    const KernelTable& target_;
    std::optional<FieldSurface> surface_;
    double edge_ = 1;
};

class Continuity : public testing::TestWithParam<std::string> {};

TEST_P(Continuity, HitsDoNotPop) {
    for (const float growth : {-0.03F, 0.0F, 0.1F}) {
        const Jumps j = Path(Lod::recursive, GetParam()).jumps(growth, 6, 16);
        EXPECT_GT(j.steps, 4000);
        EXPECT_EQ(j.pops, 0) << "growth " << growth << ", " << j.folds << " folds";
    }
}

TEST_P(Continuity, DiscreteLevelsPop) {
    EXPECT_GT(Path(Lod::discrete, GetParam()).jumps(0.1F, 6, 16).pops, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Continuity,
                         testing::Values("torus_stretched", "urchin_stretched", "cube_bilinear_stretched"),
                         [](const auto& name) { return name.param; });

/// Largest root mean square difference of the normals of pictures that follow each other while footprints
/// grow by `octaves`, and their mean. The camera stands still, so that levels of detail are all that changes.
std::pair<double, double> zoom(Lod lod, const std::string& name, double octaves, int frames) {
    Scene s = named_scene(name)->scene;
    s.settings.lod = lod;
    s.settings.width = s.settings.height = 64;
    s.settings.samples = 4;
    s.settings.light_samples = 1;
    s.lights.clear();
    s.sky = glm::vec3(0);
    s.meshes[0].edge_length /= 4;
    std::vector<float> before;
    double largest = 0, sum = 0;
    for (int f = 0; f <= frames; ++f) {
        s.settings.edge_pixels = 2 * std::exp2(octaves * f / frames);
        const RenderResult r = render_native(s, RenderOptions{});
        std::vector<float> now;
        for (const char* channel : {"normal.X", "normal.Y", "normal.Z"}) {
            const std::vector<float>& values = r.film.find(channel)->values;
            now.insert(now.end(), values.begin(), values.end());
        }
        if (!before.empty()) {
            double square = 0;
            for (std::size_t i = 0; i < now.size(); ++i)
                square += std::pow(double{now[i]} - double{before[i]}, 2);
            const double difference = std::sqrt(square / static_cast<double>(now.size() / 3));
            largest = std::max(largest, difference);
            sum += difference;
        }
        before = now;
    }
    return {largest, sum / frames};
}

TEST(Zoom, RecursiveLevelsDoNotJump) {
    fmt::print("{:<20} {:>10} {:>10} {:>10}\n", "scene", "levels", "largest", "mean");
    for (const char* name : {"torus_stretched", "urchin"}) {
        const auto recursive = zoom(Lod::recursive, name, 3, 96), discrete = zoom(Lod::discrete, name, 3, 96);
        fmt::print("{:<20} {:>10} {:>10.4f} {:>10.4f}\n", name, "recursive", recursive.first,
                   recursive.second);
        fmt::print("{:<20} {:>10} {:>10.4f} {:>10.4f}\n", name, "discrete", discrete.first, discrete.second);
        EXPECT_LT(recursive.first, 0.7 * discrete.first) << name;
    }
}

} // namespace
} // namespace razor::test
