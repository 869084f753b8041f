#include "tests/materials/plain_pattern.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace razor::test {
namespace {

using glm::dvec3;

std::uint32_t scrambled(std::uint32_t x) {
    const std::uint32_t state = x * 747796405U + 2891336453U;
    const std::uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737U;
    return (word >> 22) ^ word;
}

std::uint32_t hash_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t n) { return static_cast<std::uint32_t>(n); };
    return scrambled(scrambled(bits(z) * 0x9e3779b9U + bits(y)) + bits(x));
}

/// Perlin's twelve gradients, and four of them again.
double plain_gradient(std::uint32_t hash, const dvec3& p) {
    static constexpr std::array<std::array<int, 3>, 16> gradients{{{1, 1, 0},
                                                                   {-1, 1, 0},
                                                                   {1, -1, 0},
                                                                   {-1, -1, 0},
                                                                   {1, 0, 1},
                                                                   {-1, 0, 1},
                                                                   {1, 0, -1},
                                                                   {-1, 0, -1},
                                                                   {0, 1, 1},
                                                                   {0, -1, 1},
                                                                   {0, 1, -1},
                                                                   {0, -1, -1},
                                                                   {1, 1, 0},
                                                                   {0, -1, 1},
                                                                   {-1, 1, 0},
                                                                   {0, -1, -1}}};
    const auto& g = gradients[hash >> 28];
    return g[0] * p.x + g[1] * p.y + g[2] * p.z;
}

double plain_noise(const dvec3& q) {
    const dvec3 cell = glm::floor(q), f = q - cell;
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
        const dvec3 corner(k & 1, k >> 1 & 1, k >> 2);
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double t = f[axis], s = t * t * t * (t * (6 * t - 15) + 10);
            weight *= corner[axis] == 1 ? s : 1 - s;
        }
        const dvec3 at = cell + corner;
        sum += weight * plain_gradient(hash_of(std::int64_t(at.x), std::int64_t(at.y), std::int64_t(at.z)),
                                       f - corner);
    }
    return sum;
}

double octaves(const Pattern& p, const dvec3& q, bool folded) {
    double sum = 0, height = 1, frequency = 1;
    for (int k = 0; k < p.octaves; ++k) {
        const double value = plain_noise(q * frequency);
        sum += height * (folded ? std::abs(value) : value);
        height *= double{p.gain};
        frequency *= 1.99;
    }
    return sum;
}

} // namespace

double plain_value(const Pattern& p, const dvec3& q) {
    const auto wave = [](double x) { return 0.5 + 0.5 * std::sin(2 * std::numbers::pi * x); };
    switch (p.kind) {
    case PatternKind::checker:
        return double(std::int64_t(std::floor(q.x + 0.5) + std::floor(q.y + 0.5) + std::floor(q.z + 0.5)) &
                      1);
    case PatternKind::bricks: {
        const double row = std::floor(q.y / 0.35 + 0.5), shift = std::fmod(row, 2) != 0 ? 0.5 : 0;
        const auto within = [&](double x, double cell) {
            const double at = x - cell * std::floor(x / cell), half = 0.5 * double{p.amount};
            return at > half && at < cell - half;
        };
        return within(q.y + 0.175, 0.35) && within(q.x + shift + 0.5, 1) &&
                       within(q.z + 0.5 * shift + 0.25, 0.5)
                   ? 1
                   : 0;
    }
    case PatternKind::noise:
        return std::clamp(0.5 + 0.5 * octaves(p, q, false), 0.0, 1.0);
    case PatternKind::turbulence:
        return std::min(octaves(p, q, true), 1.0);
    case PatternKind::marble:
        return wave(q.x + double{p.amount} * octaves(p, q, true));
    case PatternKind::wood:
        return wave(std::hypot(q.x, q.z) + double{p.amount} * octaves(p, 0.25 * q, false));
    }
    return 0;
}

} // namespace razor::test
