// The beam of a group of rays: it meets every box that one of them meets and leaves to one side no plane that
// one of them reaches, and beyond its hull, found here in double precision, it meets nothing.
#include "tests/kernels/beam_kernel.h"
#include "tests/kernels/target_functions.h"

#include "razor/frame/scratch.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(beam, BeamArguments&)

namespace {

using glm::dvec3;

using Target = TargetFunction<BeamArguments&>;

constexpr int rays = RAZOR_WIDTH;
using Three = std::array<float, 3 * rays>;

dvec3 lane(const Three& values, int i) {
    const auto n = static_cast<std::size_t>(i);
    return {values[n], values[n + rays], values[n + 2 * rays]};
}
void set_lane(Three& values, int i, const dvec3& v) {
    for (int k = 0; k < 3; ++k)
        values[static_cast<std::size_t>(i + k * rays)] = static_cast<float>(v[k]);
}

/// From around one place to around another: where both are wide, as hits look at a light; a point, as a
/// camera's; of either sign along axes across.
struct Rig {
    Three origin{}, direction{};
    std::array<float, rays> t_max{};
    int axis = 0;
};

Rig make_rig(std::mt19937& random, double reach) {
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
    const auto around = [&](double size) {
        return dvec3(uniform(-size, size), uniform(-size, size), uniform(-size, size));
    };
    const double sizes[] = {0, 1e-3, 0.02, 0.1};
    Rig rig;
    rig.axis = static_cast<int>(random() % 3);
    const double wide_from = reach * sizes[random() % 4], wide_to = reach * sizes[random() % 4];
    dvec3 from = around(0.2 * reach), way = around(0.25 * reach);
    way[rig.axis] = uniform(0.45, 0.6) * reach * (random() % 2 == 0 ? 1 : -1);
    way *= random() % 4 == 0 ? uniform(1e-4, 1e-2) : 1.0; // short ones too
    const double part = glm::length(way) / reach;
    for (int i = 0; i < rays; ++i) {
        const dvec3 o = from + around(wide_from * part), d = from + way + around(wide_to * part) - o;
        const double length = glm::length(d);
        set_lane(rig.origin, i, o);
        set_lane(rig.direction, i, d / length);
        rig.t_max[static_cast<std::size_t>(i)] = static_cast<float>(length);
    }
    return rig;
}

/// Whether the ray is in the box somewhere, in double precision.
bool meets(const Rig& rig, int ray, const dvec3& low, const dvec3& high) {
    double enter = 0, leave = rig.t_max[static_cast<std::size_t>(ray)];
    const dvec3 o = lane(rig.origin, ray), d = lane(rig.direction, ray);
    for (int k = 0; k < 3; ++k) {
        if (d[k] == 0 && (o[k] < low[k] || o[k] > high[k]))
            return false;
        if (d[k] == 0)
            continue;
        const double a = (low[k] - o[k]) / d[k], b = (high[k] - o[k]) / d[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

/// The hull by its definition.
struct Hull {
    double begin = 1e300, end = -1e300;
    dvec3 low[2]{dvec3(1e300), dvec3(1e300)}, high[2]{dvec3(-1e300), dvec3(-1e300)}; // at begin and end

    explicit Hull(const Rig& rig) {
        const int z = rig.axis;
        for (int i = 0; i < rays; ++i)
            for (const double t : {0.0, static_cast<double>(rig.t_max[static_cast<std::size_t>(i)])}) {
                const double at = lane(rig.origin, i)[z] + t * lane(rig.direction, i)[z];
                begin = std::min(begin, at);
                end = std::max(end, at);
            }
        for (int i = 0; i < rays; ++i)
            for (int side = 0; side < 2; ++side) {
                const dvec3 o = lane(rig.origin, i), d = lane(rig.direction, i);
                const dvec3 p = o + d * (((side == 0 ? begin : end) - o[z]) / d[z]);
                low[side] = glm::min(low[side], p);
                high[side] = glm::max(high[side], p);
            }
    }
    dvec3 between(const dvec3 (&ends)[2], double z) const {
        return ends[0] + (ends[1] - ends[0]) * ((z - begin) / (end - begin));
    }
    /// How far the box is from the hull along an axis across, or along the rays' own; negative if it is not.
    double distance(int axis, const dvec3& box_low, const dvec3& box_high) const {
        const double from = std::max(begin, box_low[axis]), to = std::min(end, box_high[axis]);
        double apart = from - to;
        for (int k = 0; k < 3 && from <= to; ++k)
            if (k != axis) {
                apart = std::max(apart, std::min(between(low, from)[k], between(low, to)[k]) - box_high[k]);
                apart = std::max(apart, box_low[k] - std::max(between(high, from)[k], between(high, to)[k]));
            }
        return apart;
    }
};

void try_rigs(const Target& target, double reach) {
    std::mt19937 random(7);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
    const auto frame = std::make_unique<FrameHeader>();
    frame->reach = static_cast<float>(reach);
    std::vector<float> packets(packet_floats);
    std::array<float, 6 * rays> boxes{};
    std::array<std::int32_t, rays> met{};
    int touched = 0, clear = 0, above = 0, below = 0;
    for (int n = 0; n < 1000; ++n) {
        const Rig rig = make_rig(random, reach);
        const Hull hull(rig);
        BeamArguments a;
        a.frame = frame.get();
        a.packets = packets.data();
        a.origin = rig.origin.data();
        a.direction = rig.direction.data();
        a.t_max = rig.t_max.data();
        a.axis = rig.axis;
        a.boxes = boxes.data();
        a.met = met.data();
        a.widen = n % 3 == 0 ? static_cast<float>(uniform(0, 0.01 * reach)) : 0;
        for (float& s : a.shift)
            s = n % 2 == 0 ? 0 : static_cast<float>(uniform(-0.3, 0.3) * reach);
        // Boxes near a ray, as the kernel sees them: their words in single precision, moved and widened.
        std::array<dvec3, rays> low, high;
        const double size = glm::length(hull.high[1] - hull.low[0]);
        for (int b = 0; b < rays; ++b) {
            const int i = static_cast<int>(random() % rays);
            const double t = uniform(-0.1, 1.1) * rig.t_max[static_cast<std::size_t>(i)];
            dvec3 at = lane(rig.origin, i) + t * lane(rig.direction, i);
            double half = size * std::pow(10.0, uniform(-4, -1));
            if (b % 4 == 0) // on the ray, as small as rounding lets it be
                half = reach / (1 << 27);
            else
                at += size * std::pow(10.0, uniform(-4, 0)) *
                      dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            for (int k = 0; k < 3; ++k) {
                float& l = boxes[static_cast<std::size_t>(k * rays + b)];
                float& h = boxes[static_cast<std::size_t>((k + 3) * rays + b)];
                l = static_cast<float>(at[k] - half - a.shift[k]);
                h = static_cast<float>(at[k] + half - a.shift[k]);
                low[static_cast<std::size_t>(b)][k] = static_cast<double>(l) + a.shift[k] - a.widen;
                high[static_cast<std::size_t>(b)][k] = static_cast<double>(h) + a.shift[k] + a.widen;
            }
        }
        a.plane_axis = static_cast<int>(random() % 3);
        a.plane = static_cast<float>(lane(rig.origin, 0)[a.plane_axis] + size * uniform(-1.5, 1.5));
        target.run(a);
        // Short beams have no slope: their sides may be as far apart as those ends.
        const bool is_short = hull.end - hull.begin < reach / 512;
        const double room = 64 * 12.0 / 16777216 * reach; // the beam may be wider by that
        for (int b = 0; b < rays; ++b) {
            const auto at = static_cast<std::size_t>(b);
            bool some = false;
            for (int i = 0; i < rays; ++i)
                some = some || meets(rig, i, low[at], high[at]);
            touched += some ? 1 : 0;
            if (some) {
                ASSERT_EQ(met[at], 1) << target.name << ", rig " << n << ", box " << b;
            }
            if (!some && !is_short && hull.distance(rig.axis, low[at], high[at]) > 4 * a.widen + room) {
                ++clear;
                ASSERT_EQ(met[at], 0) << target.name << ", rig " << n << ", box " << b;
            }
        }
        double least = 1e300, most = -1e300;
        for (int i = 0; i < rays; ++i)
            for (const double t : {0.0, static_cast<double>(rig.t_max[static_cast<std::size_t>(i)])}) {
                const double p = (lane(rig.origin, i) + t * lane(rig.direction, i))[a.plane_axis];
                least = std::min(least, p);
                most = std::max(most, p);
            }
        if (least < a.plane) {
            ASSERT_EQ(a.high, 0) << target.name << ", rig " << n;
        }
        if (most > a.plane) {
            ASSERT_EQ(a.low, 0) << target.name << ", rig " << n;
        }
        // The hull goes with each ray as far as any of them goes.
        const int k = a.plane_axis;
        const bool own = k == rig.axis;
        const double from = own ? hull.begin : std::min(hull.low[0][k], hull.low[1][k]);
        const double to = own ? hull.end : std::max(hull.high[0][k], hull.high[1][k]);
        if (from > a.plane + room && !is_short) {
            ++above;
            ASSERT_EQ(a.high, 1) << target.name << ", rig " << n;
        }
        if (to < a.plane - room && !is_short) {
            ++below;
            ASSERT_EQ(a.low, 1) << target.name << ", rig " << n;
        }
    }
    EXPECT_GT(touched, 20 * rays) << target.name;
    EXPECT_GT(clear, 50 * rays) << target.name;
    EXPECT_GT(above, 50) << target.name;
    EXPECT_GT(below, 50) << target.name;
}

TEST(Beam, MeetsWhatRaysMeetAndLittleElse) {
    for (const Target& target : beam_of_targets())
        for (const double reach : {1e-6, 1.0, 1e7})
            try_rigs(target, reach);
}

} // namespace
} // namespace razor::test
