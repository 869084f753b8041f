// The fields of rays that leave hits: what a ray shares with others, of its packet or of those before, is
// never finer than what it asks for where it begins, never grows faster, and lacks little of either.
#include "razor/frame/scratch.h"
#include "tests/kernels/leave_kernel.h"
#include "tests/kernels/target_functions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace razor::test {

RAZOR_TEST_FUNCTION(leave, LeaveArguments&)

namespace {

using Target = TargetFunction<LeaveArguments&>;

constexpr std::size_t rays = RAZOR_WIDTH;

struct Packet {
    std::array<float, 3 * rays> position{}, origin{};
    std::array<float, rays> target{}, wanted{}, radius{}, base{}, growth{};
    std::array<std::int32_t, rays> hit{}, number{};
};

/// Hits around `centre` that ask for edges around `edge`; growths of one sign, around `growth`.
Packet make_packet(std::mt19937& random, double centre, double edge, double growth) {
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
    Packet p;
    for (std::size_t i = 0; i < rays; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            p.position[i + k * rays] = static_cast<float>(centre + uniform(-20, 20) * edge);
        p.target[i] = static_cast<float>(edge * uniform(0.95, 1.1));
        p.hit[i] = random() % 8 == 0 ? 0 : 1;
        // What lanes without a ray hold counts for nothing.
        p.wanted[i] = static_cast<float>(p.hit[i] == 0 ? -9 : growth * uniform(1, 1.5));
    }
    p.hit[0] = 1;
    return p;
}

/// What all of a packet's rays may grow by.
double slowest(const Packet& p) {
    double least = gradation_cap;
    for (std::size_t i = 0; i < rays; ++i)
        if (p.hit[i] != 0)
            least = std::min(least, double{p.wanted[i]});
    return std::max(least, -double{gradation_cap});
}

using FieldValues = std::array<float, 6>;
FieldValues values_of(const Packet& p, std::size_t i) {
    return {p.origin[i], p.origin[i + rays], p.origin[i + 2 * rays], p.radius[i], p.base[i], p.growth[i]};
}

void check(const Packet& p) {
    const double most = slowest(p);
    for (std::size_t i = 0; i < rays; ++i) {
        if (p.hit[i] == 0)
            continue;
        const double growth = p.growth[i], base = p.base[i], target = p.target[i];
        ASSERT_LE(growth, most) << "of ray " << i;
        ASSERT_GE(growth, std::max(most - 0.2501 * std::abs(most), -double{gradation_cap})) << "of ray " << i;
        ASSERT_GE(base, target) << "of ray " << i;
        ASSERT_LE(base, target * 1.1026) << "of ray " << i; // 1.05 squared
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k)
            square += std::pow(double{p.position[i + k * rays]} - p.origin[i + k * rays], 2);
        // Constant for eight edges around each hit.
        ASSERT_LE(std::sqrt(square) + 7.9999 * base, p.radius[i] * 1.00001) << "of ray " << i;
    }
}

LeaveArguments arguments(FrameHeader& frame, WorkerRecord& self, std::vector<float>& scratch, Packet& p) {
    LeaveArguments a;
    a.frame = &frame;
    a.self = &self;
    a.packets = scratch.data();
    a.position = p.position.data();
    a.target = p.target.data();
    a.wanted = p.wanted.data();
    a.hit = p.hit.data();
    a.origin = p.origin.data();
    a.radius = p.radius.data();
    a.base = p.base.data();
    a.growth = p.growth.data();
    a.number = p.number.data();
    return a;
}

void share_fields(const Target& target) {
    std::mt19937 random(11);
    std::vector<float> scratch(packet_floats);
    FrameHeader frame{};
    WorkerRecord self{};
    std::int64_t shared = 0, fresh = 0;
    for (const double size : {1e-4, 1.0, 3e4})
        for (const double growth : {-0.3, -0.02, -1e-5, 0.0, 1e-6, 0.004, 0.09, 0.3}) {
            bool forget = true;
            std::map<std::int32_t, FieldValues> seen; // by number
            std::set<std::int32_t> before;
            for (int step = 0; step < 60; ++step) {
                // Growths wander by less than what a field lacks, and by more.
                const double wander = 1 + 0.5 * std::sin(0.1 * step);
                Packet p = make_packet(random, size * (step % 2), size, growth * wander);
                LeaveArguments a = arguments(frame, self, scratch, p);
                a.forget = std::exchange(forget, false);
                target.run(a);
                SCOPED_TRACE(testing::Message() << size << ", " << growth << ", packet " << step);
                check(p);
                if (testing::Test::HasFatalFailure())
                    return;
                for (std::size_t i = 0; i < rays; ++i) {
                    if (p.hit[i] == 0)
                        continue;
                    const auto [at, first] = seen.try_emplace(p.number[i], values_of(p, i));
                    ASSERT_EQ(at->second, values_of(p, i)) << "fields of one number differ";
                    ++(before.contains(p.number[i]) ? shared : fresh);
                }
                for (const auto& [number, values] : seen)
                    before.insert(number);
            }
        }
    // Some go with what a packet before theirs made, others do not.
    EXPECT_GT(shared, 10000);
    EXPECT_GT(fresh, 10000);
}

/// After the largest number comes the first again: neither the camera's nor one that says that there is none.
TEST(Leave, FieldsHaveNumbersOfTheirOwn) {
    for (const Target& target : leave_of_targets()) {
        SCOPED_TRACE(target.name);
        std::mt19937 random(12);
        std::vector<float> scratch(packet_floats);
        FrameHeader frame{};
        WorkerRecord self{};
        self.next_field = std::numeric_limits<std::int32_t>::max() - 1;
        std::set<std::int32_t> numbers;
        for (int step = 0; step < 8; ++step) {
            Packet p = make_packet(random, 1000 * step, 1, 0.01);
            LeaveArguments a = arguments(frame, self, scratch, p);
            a.forget = step == 0;
            target.run(a);
            for (std::size_t i = 0; i < rays; ++i)
                if (p.hit[i] != 0)
                    numbers.insert(p.number[i]);
        }
        EXPECT_GT(*numbers.begin(), camera_number);
        EXPECT_EQ(*numbers.begin(), 1);
        EXPECT_EQ(*numbers.rbegin(), std::numeric_limits<std::int32_t>::max());
    }
}

TEST(Leave, FieldsAreSharedByThoseWhomTheySuit) {
    for (const Target& target : leave_of_targets()) {
        SCOPED_TRACE(target.name);
        share_fields(target);
    }
}

} // namespace
} // namespace razor::test
