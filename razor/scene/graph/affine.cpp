#include "razor/scene/graph/affine.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace razor {
namespace {

double largest_entry(const glm::dmat3& m) {
    double largest = 0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            const double size = std::abs(m[column][row]);
            if (!std::isfinite(size)) {
                return std::numeric_limits<double>::quiet_NaN();
            }
            largest = std::max(largest, size);
        }
    }
    return largest;
}

/// The largest entry becomes a number in [1, 2): products of entries neither overflow nor vanish together.
glm::dmat3 normalised(const glm::dmat3& m, int exponent) {
    glm::dmat3 result;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            result[column][row] = std::ldexp(m[column][row], -exponent);
        }
    }
    return result;
}

/// Turns two columns in their plane until they are orthogonal; whether they were not.
bool rotate_columns(glm::dvec3& a, glm::dvec3& b) {
    const double aa = glm::dot(a, a);
    const double bb = glm::dot(b, b);
    const double ab = glm::dot(a, b);
    if (std::abs(ab) <= std::numeric_limits<double>::epsilon() * std::sqrt(aa) * std::sqrt(bb)) {
        return false;
    }
    const double zeta = (bb - aa) / (2 * ab);
    const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
    const double c = 1 / std::hypot(1.0, t);
    const double s = c * t;
    const glm::dvec3 old = a;
    a = c * old - s * b;
    b = s * old + c * b;
    return true;
}

} // namespace

Affine inverse(const Affine& a) {
    const int exponent = std::ilogb(largest_entry(a.linear));
    const glm::dmat3 back = normalised(glm::inverse(normalised(a.linear, exponent)), exponent);
    return {back, -(back * a.translation)};
}

glm::dvec3 singular_values(const glm::dmat3& m) {
    const double largest = largest_entry(m);
    if (std::isnan(largest)) {
        return glm::dvec3(largest);
    }
    if (largest == 0) {
        return glm::dvec3(0);
    }
    const int exponent = std::ilogb(largest);
    glm::dmat3 u = normalised(m, exponent);
    constexpr int sweeps = 40; // convergence is quadratic: six do
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const bool turned01 = rotate_columns(u[0], u[1]);
        const bool turned02 = rotate_columns(u[0], u[2]);
        const bool turned12 = rotate_columns(u[1], u[2]);
        if (!turned01 && !turned02 && !turned12) {
            break;
        }
    }
    std::array<double, 3> values{};
    for (int i = 0; i < 3; ++i) {
        values[static_cast<std::size_t>(i)] = std::ldexp(std::hypot(u[i].x, u[i].y, u[i].z), exponent);
    }
    std::sort(values.begin(), values.end());
    return {values[2], values[1], values[0]};
}

bool is_degenerate(const glm::dmat3& m) {
    const glm::dvec3 values = singular_values(m);
    return !(values.z > 0 && values.z >= least_relative_scale * values.x);
}

bool is_mirrored(const glm::dmat3& m) {
    return glm::determinant(normalised(m, std::ilogb(largest_entry(m)))) < 0;
}

std::pair<double, double> cos_sin_degrees(double angle) {
    const double turn = std::remainder(angle, 360.0);
    if (std::fmod(turn, 90.0) == 0) {
        constexpr int cosines[] = {1, 0, -1, 0};
        const int quarter = (static_cast<int>(turn / 90.0) + 4) % 4;
        return {cosines[quarter], cosines[(quarter + 3) % 4]};
    }
    const double radians = turn * (std::numbers::pi / 180.0);
    return {std::cos(radians), std::sin(radians)};
}

Affine to_affine(const Transform& transform) {
    if (transform.matrix) {
        return *transform.matrix;
    }
    Affine result{glm::dmat3(0), transform.translate};
    for (int i = 0; i < 3; ++i) {
        result.linear[i][i] = transform.scale[i];
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (transform.rotate[axis] == 0) {
            continue;
        }
        const auto [c, s] = cos_sin_degrees(transform.rotate[axis]);
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (int column = 0; column < 3; ++column) {
            const double pu = result.linear[column][u];
            const double pv = result.linear[column][v];
            result.linear[column][u] = c * pu - s * pv;
            result.linear[column][v] = s * pu + c * pv;
        }
    }
    return result;
}

} // namespace razor
