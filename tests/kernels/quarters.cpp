// Points of lights dealt to packets: each hit has the points of its sequence, all of them and no other, in an
// order by where they lie; and packets of which the light is large beside the hits hold together.
#include "tests/kernels/cages.h"
#include "tests/kernels/quarters_kernel.h"
#include "tests/kernels/target_functions.h"

#include "razor/frame/scratch.h"
#include "razor/native/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(quarter, QuarterArguments&)
RAZOR_TEST_FUNCTION(extent, ExtentArguments&)

namespace {

constexpr int width = RAZOR_WIDTH;

using SquarePoint = std::pair<float, float>;

/// A packet's hits, on the unit square's floor if nothing else is said.
struct Hits {
    alignas(64) float packets[packet_floats] = {};
    alignas(64) std::int32_t pixel[width], first[width], hit[width], fine[width];
    alignas(64) float place[3 * width];
    std::vector<float> dealt_u, dealt_v, own_u, own_v;
    std::vector<std::int32_t> numbers;
    QuarterArguments a;

    explicit Hits(int samples) {
        std::mt19937 random(7);
        for (int i = 0; i < width; ++i) {
            pixel[i] = static_cast<std::int32_t>(random());
            first[i] = static_cast<std::int32_t>(random() % 1000) * samples;
            hit[i] = 1;
            fine[i] = 0;
            place[i] = static_cast<float>(i) / (width - 1);
            place[width + i] = 0;
            place[2 * width + i] = static_cast<float>(i % 4) / 3;
        }
        const auto room = static_cast<std::size_t>(samples) * width;
        numbers.resize(room + 64);
        for (std::vector<float>* v : {&dealt_u, &dealt_v, &own_u, &own_v})
            v->resize(room + 64);
        a = {packets,
             pixel,
             first,
             samples,
             dimension_light,
             aligned(dealt_u),
             aligned(dealt_v),
             aligned(numbers),
             aligned(own_u),
             aligned(own_v),
             place,
             hit,
             fine,
             0,
             0};
    }
    Hits(const Hits&) = delete;
    Hits& operator=(const Hits&) = delete;

    SquarePoint dealt(int k, int lane) const { return at(a.dealt_u, a.dealt_v, k, lane); }
    int number(int k, int lane) const { return a.number[k * width + lane]; }
    SquarePoint own(int k, int lane) const { return at(a.own_u, a.own_v, k, lane); }

private:
    template <class T> static T* aligned(std::vector<T>& v) {
        void* at = v.data();
        std::size_t room = v.size() * sizeof(T);
        return static_cast<T*>(std::align(64, room - 64 * sizeof(T), at, room));
    }
    static SquarePoint at(const float* u, const float* v, int k, int lane) {
        return {u[k * width + lane], v[k * width + lane]};
    }
};

// Each four by u, then the halves by v: as sorting does.
TEST(Quarters, HoldEachHitsOwnPoints) {
    for (const auto& t : quarter_of_targets())
        for (const int samples : {2, 3, 4, 5, 7, 16}) {
            SCOPED_TRACE(std::string(t.name) + ", samples " + std::to_string(samples));
            Hits h(samples);
            t.run(h.a);
            for (int lane = 0; lane < width; ++lane)
                for (int k = 0; k < samples; k += quarters) {
                    const int n = std::min(quarters, samples - k);
                    std::vector<SquarePoint> expected;
                    for (int i = 0; i < n; ++i)
                        expected.push_back(h.own(k + i, lane));
                    std::sort(expected.begin(), expected.end());
                    const auto by_v = [](const SquarePoint& x, const SquarePoint& y) {
                        return x.second < y.second;
                    };
                    std::sort(expected.begin(), expected.begin() + std::min(n, 2), by_v);
                    if (n > 2)
                        std::sort(expected.begin() + 2, expected.end(), by_v);
                    for (int i = 0; i < n; ++i)
                        EXPECT_EQ(h.dealt(k + i, lane), expected[static_cast<std::size_t>(i)]) << lane;
                    for (int i = 0; i < n; ++i)
                        EXPECT_EQ(h.dealt(k + i, lane), h.own(k + h.number(k + i, lane), lane)) << lane;
                }
        }
}

TEST(Quarters, PayWhereTheLightIsLargeBesideManyHits) {
    for (const auto& t : quarter_of_targets()) {
        SCOPED_TRACE(t.name);
        Hits h(4);
        const auto pays = [&](float extent) {
            h.a.extent = extent;
            t.run(h.a);
            return h.a.pays != 0;
        };
        EXPECT_TRUE(pays(2)); // hits lie 1 apart
        EXPECT_TRUE(pays(3.0e38F));
        EXPECT_FALSE(pays(1.9F));
        EXPECT_FALSE(pays(0));
        // A lane that hit nothing is nowhere.
        h.place[2 * width + 5] = 100;
        EXPECT_FALSE(pays(2));
        h.hit[5] = 0;
        EXPECT_TRUE(pays(2));
        h.hit[5] = 1;
        h.place[2 * width + 5] = 0;
        // One at no place at all.
        h.place[width + 3] = std::nanf("");
        pays(2);
        h.place[width + 3] = 0;
        for (int i = 0; i < width; ++i)
            h.fine[i] = i < width / 4;
        EXPECT_TRUE(pays(2));
        h.fine[width / 4] = 1;
        EXPECT_FALSE(pays(2));
        std::fill(h.fine, h.fine + width, 0);
        for (int i = 0; i < width; ++i)
            h.hit[i] = i < width / 2 + 1;
        EXPECT_TRUE(pays(2));
        h.hit[width / 2] = 0;
        EXPECT_FALSE(pays(2));
    }
}

TEST(Quarters, AreOfLightsAsFarAsTheyReach) {
    FrameHeader frame{};
    frame.reach = 50;
    LightRecord light{};
    light.edge_u[0] = 3; // a rectangle's edge, a disk's radius
    light.edge_v[2] = 3;
    light.radius = 0.5F;
    light.versine = 1 - std::cos(0.1F);
    for (const auto& t : extent_of_targets()) {
        SCOPED_TRACE(t.name);
        const auto extent = [&](LightShape shape) {
            light.shape = shape;
            ExtentArguments a{&frame, &light, -1};
            t.run(a);
            return a.extent;
        };
        EXPECT_FLOAT_EQ(extent(light_rectangle), 3);
        EXPECT_FLOAT_EQ(extent(light_disk), 6);
        EXPECT_FLOAT_EQ(extent(light_sphere), 1);
        EXPECT_EQ(extent(light_point), 0);
        EXPECT_NEAR(extent(light_directional), 2 * 50 * std::sin(0.1), 1e-3);
        light.edge_v[2] = 4;
        EXPECT_FLOAT_EQ(extent(light_rectangle), 4); // the longer one
        light.edge_v[2] = 3;
    }
}

/// A flat floor below a wide square light just above it.
RenderResult lit_floor(Scheme scheme) {
    Mesh floor;
    floor.name = "floor";
    floor.scheme = scheme;
    floor.points = {{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}};
    floor.face_sizes = {4};
    floor.face_vertices = {0, 1, 2, 3};
    Scene s = scene_of(floor, 100);
    s.lights = {{{-3, 2, -3}, {6, 0, 0}, {0, 0, 6}, {1, 1, 1}}};
    s.camera.position = {0, 8, 0.5};
    s.camera.target = {0, 0, 0};
    s.camera.fov_degrees = 20;
    s.settings = {
        .lod = Lod::fixed, .width = 32, .height = 32, .samples = 4, .light_samples = 4, .sky_samples = 0};
    RenderOptions options;
    options.threads = 1;
    return render_native(s, options);
}

// Rays to all of the light are long along more axes than those to a quarter of it. A limit surface's floor is
// as flat and of many cells, from which points are not dealt: rays are the same, and so is the light.
TEST(Quarters, MakeFewerGroupsOfTheSameRays) {
    const RenderResult dealt = lit_floor(Scheme::bilinear);
    const RenderResult as_they_come = lit_floor(Scheme::catmull_clark);
    const Counters& one = dealt.statistics.frame.by_kind.kind[kind_light];
    const Counters& other = as_they_come.statistics.frame.by_kind.kind[kind_light];
    EXPECT_EQ(one.rays, 32 * 32 * 4 * 4);
    EXPECT_EQ(other.rays, one.rays);
    EXPECT_EQ(one.packets * RAZOR_WIDTH, one.rays);
    EXPECT_LT(static_cast<double>(one.groups), 0.9 * static_cast<double>(other.groups));
    const std::vector<float>& a = dealt.film.find("R")->values;
    const std::vector<float>& b = as_they_come.film.find("R")->values;
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a[i], b[i], 1e-5F * b[i]) << i;
}

} // namespace
} // namespace razor::test
