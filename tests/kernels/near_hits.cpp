// Hits are ordered along the axis along which they are spread most, and packets of shadow rays hold those
// that lie near each other, whatever pixels they are of.
#include "tests/kernels/cages.h"
#include "tests/kernels/near_hits_kernel.h"
#include "tests/kernels/target_functions.h"

#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(order_hits, NearHitsArguments&)

namespace {

constexpr int packet = RAZOR_WIDTH;

struct PlacedHits {
    alignas(64) float place[3 * packet] = {};
    alignas(64) std::int32_t hit[packet] = {};
    alignas(64) std::int32_t order[packet] = {};

    std::vector<int> ordered(const TargetFunction<NearHitsArguments&>& t) {
        NearHitsArguments a{place, hit, order};
        t.run(a);
        return {order, order + packet};
    }
    /// Lanes that hit something, by a coordinate and then by their numbers; then the others.
    std::vector<int> expected(int axis) const {
        std::vector<int> lanes(packet);
        std::iota(lanes.begin(), lanes.end(), 0);
        std::stable_sort(lanes.begin(), lanes.end(), [&](int a, int b) {
            if (hit[a] != hit[b])
                return hit[a] > hit[b];
            return hit[a] != 0 && place[axis * packet + a] < place[axis * packet + b];
        });
        return lanes;
    }
};

TEST(NearHits, AreOrderedAlongTheAxisOnWhichTheySpreadMost) {
    std::mt19937 random(3);
    for (const auto& t : order_hits_of_targets())
        for (int turn = 0; turn < 60; ++turn) {
            PlacedHits h;
            const int axis = turn % 3;
            const float scale = turn % 4 == 0 ? 1e-9F : turn % 4 == 1 ? 1e9F : 1;
            for (int i = 0; i < packet; ++i) {
                h.hit[i] = turn < 6 || random() % 4 != 0;
                for (int k = 0; k < 3; ++k) {
                    // Few places, so that several hits have the same.
                    const float at = static_cast<float>(random() % 50);
                    const bool missed = h.hit[i] == 0; // where those are does not count
                    h.place[k * packet + i] = scale * (missed ? 1000 * at : k == axis ? 7 * at - 100 : at);
                }
            }
            EXPECT_EQ(h.ordered(t), h.expected(axis)) << t.name << ", turn " << turn;
        }
}

TEST(NearHits, AreAllThereWhereverTheyAre) {
    constexpr float infinite = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float places[] = {0, -0.0F, 1e38F, -1e38F, 3e38F, -3e38F, 1e-45F, infinite, -infinite, nan};
    std::mt19937 random(5);
    for (const auto& t : order_hits_of_targets())
        for (int turn = 0; turn < 200; ++turn) {
            PlacedHits h;
            const std::size_t kinds = static_cast<std::size_t>(turn) % std::size(places) + 1;
            for (int i = 0; i < packet; ++i)
                h.hit[i] = random() % 3 != 0;
            for (float& p : h.place)
                p = places[random() % kinds];
            std::vector<int> order = h.ordered(t);
            const auto hits = std::count(h.hit, h.hit + packet, 1);
            for (int i = 0; i < packet; ++i)
                ASSERT_EQ(h.hit[order[static_cast<std::size_t>(i)]], i < hits) << t.name << ", turn " << turn;
            std::sort(order.begin(), order.end());
            for (int i = 0; i < packet; ++i)
                ASSERT_EQ(order[static_cast<std::size_t>(i)], i) << t.name << ", turn " << turn;
        }
}

/// A floor seen from above between slats a pixel wide, along x or along z, in the light of a small square.
RenderStatistics slats(bool along_x) {
    Mesh mesh;
    mesh.name = "slats";
    mesh.scheme = Scheme::bilinear;
    const auto add = [&](float low, float high, float begin, float end, float y) {
        const int first = static_cast<int>(mesh.points.size());
        for (const auto& [a, b] : {std::pair{low, begin}, {low, end}, {high, end}, {high, begin}})
            mesh.points.push_back(along_x ? glm::vec3(b, y, -a) : glm::vec3(a, y, b));
        mesh.face_sizes.push_back(4);
        for (int i = 0; i < 4; ++i)
            mesh.face_vertices.push_back(first + i);
    };
    add(-20, 20, -20, 20, -6);
    for (int i = -16; i < 16; i += 2)
        add(static_cast<float>(i), static_cast<float>(i + 1), -16, 16, 0);
    Scene s = scene_of(mesh, 100);
    s.lights = {{{9, 8, 9}, {1, 0, 0}, {0, 0, 1}, {1, 1, 1}}};
    s.camera.projection = Projection::orthographic;
    s.camera.position = {0, 30, 0};
    s.camera.target = {0, 0, 0};
    s.camera.up = {0, 0, -1};
    s.camera.height = 32;
    s.settings = {
        .lod = Lod::fixed, .width = 32, .height = 32, .samples = 4, .light_samples = 4, .sky_samples = 0};
    RenderOptions options;
    options.threads = 1;
    return render_native(s, options).statistics;
}

// Packets are wider than high: of every other column a pixel lies on a slat and its neighbour far below.
TEST(NearHits, SharePacketsWhateverPixelsTheyAreOf) {
    const Counters across = slats(false).frame.by_kind.kind[kind_light];
    const Counters down = slats(true).frame.by_kind.kind[kind_light];
    EXPECT_EQ(across.rays, down.rays);
    ASSERT_GT(down.box_tests, 500);
    const auto ratio = [](std::int64_t a, std::int64_t b) {
        return static_cast<double>(a) / static_cast<double>(b);
    };
    // 2.36 and 1.09 where pixels side by side go together.
    EXPECT_LT(ratio(across.box_tests, down.box_tests), 1.6);
    EXPECT_LT(ratio(across.node_visits, down.node_visits), 1.05);
}

} // namespace
} // namespace razor::test
