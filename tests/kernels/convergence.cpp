// Hits come nearer to the limit surface as the square of the edges that rays ask for: flat triangles on a
// smooth surface.
#include "razor/check/field_surface.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/targets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

class Convergence : public testing::TestWithParam<std::string> {};

TEST_P(Convergence, IsOfSecondOrder) {
    std::optional<NamedScene> named = named_scene(GetParam());
    if (!named)
        GTEST_SKIP() << "the shared scenes are not there";
    Scene scene = named->scene;
    scene.settings.lod = Lod::recursive;
    scene.meshes[0].edge_length /= 16; // exponents end at 8: the limit, for edges that are many times as long
    const KernelTable& target = *native_targets().back();
    Frame frame(scene, {});
    Tracer tracer(frame, 4096);
    frame.build_all(target);
    const Oracle oracle(frame, true);
    RayMaker make(oracle.triangles(), oracle.origins(), 41);
    std::vector<Ray> rays;
    while (rays.size() < 4096) {
        Ray r = make.random_ray();
        r.direction = make.direction_at_feature(r.origin);
        r.base = least_target_edge;
        rays.push_back(r);
    }
    const double edge = frame.header().instances.get()[0].edge_length;
    const std::vector<Hit> limit = tracer.closest(target, rays);
    std::vector<double> x, y;
    for (int octave = 8; octave >= 4; --octave) {
        for (Ray& r : rays)
            r.base = static_cast<float>(std::ldexp(edge, octave - 1));
        const std::vector<Hit> hits = tracer.closest(target, rays);
        std::vector<double> errors;
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (hits[i].patch >= 0 && limit[i].patch >= 0)
                errors.push_back(std::abs(double{hits[i].t} - double{limit[i].t}));
        // The median: silhouettes and folds are no matter of order.
        auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
        std::nth_element(errors.begin(), middle, errors.end());
        ASSERT_GT(errors.size(), 500U);
        x.push_back(octave);
        y.push_back(std::log2(*middle));
    }
    double mean_x = 0, mean_y = 0, xy = 0, xx = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / static_cast<double>(x.size());
        mean_y += y[i] / static_cast<double>(x.size());
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xy += (x[i] - mean_x) * (y[i] - mean_y);
        xx += (x[i] - mean_x) * (x[i] - mean_x);
    }
    const double slope = xy / xx;
    RecordProperty("slope", std::to_string(slope));
    EXPECT_GT(slope, 1.6);
    EXPECT_LT(slope, 2.4);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Convergence, testing::Values("cube", "torus_stretched", "urchin"),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
