// Paths of light, textures and a map of the sky are the same on every target that fuses, to the last bit, and
// nearly so on the one that does not.
#include "tests/kernels/targets.h"
#include "tests/materials/room.h"

#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <cmath>

namespace razor::test {
namespace {

std::vector<float> picture(const Scene& scene, const KernelTable* target) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target->name;
    const Film film = render_native(scene, options).film;
    std::vector<float> values;
    for (const Plane& plane : film.planes)
        values.insert(values.end(), plane.values.begin(), plane.values.end());
    return values;
}

TEST(TargetsOfPaths, ShowTheSame) {
    const Scene scene = full_room();
    const std::vector<float> best = picture(scene, native_targets().back());
    for (const KernelTable* target : native_targets()) {
        const std::vector<float> values = picture(scene, target);
        ASSERT_EQ(values.size(), best.size());
        if (std::string(target->name) != "sse4") {
            EXPECT_EQ(values, best) << target->name;
            continue;
        }
        double sum = 0, difference = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (std::isfinite(best[i])) {
                sum += std::abs(double{best[i]});
                difference += std::abs(double{values[i]} - best[i]);
            }
        EXPECT_LT(difference, 0.02 * sum) << target->name; // few paths part by a last bit
    }
}

} // namespace
} // namespace razor::test
