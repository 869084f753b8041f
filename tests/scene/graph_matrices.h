// Transforms as plain matrix products in extended precision, to compare with.
#pragma once

#include "razor/scene/graph/records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace razor {

using Real = long double;
using Vector = std::array<Real, 3>;
/// Rows of a 3 x 4 matrix.
using Matrix = std::array<std::array<Real, 4>, 3>;

inline Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            c[i][j] = j == 3 ? a[i][3] : 0;
            for (std::size_t k = 0; k < 3; ++k) {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    return c;
}

inline Matrix diagonal(Real x, Real y, Real z) {
    return {{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}};
}

inline Matrix rotation(std::size_t axis, Real degrees) {
    const Real angle = degrees * std::numbers::pi_v<Real> / 180;
    Matrix m = diagonal(1, 1, 1);
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    m[u][u] = m[v][v] = std::cos(angle);
    m[u][v] = -std::sin(angle);
    m[v][u] = std::sin(angle);
    return m;
}

inline Matrix matrix_of(const Affine& a) {
    Matrix m{};
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = a.linear[j][i];
        }
        m[static_cast<std::size_t>(i)][3] = a.translation[i];
    }
    return m;
}

inline Matrix matrix_of(const Transform& t) {
    if (t.matrix) {
        return matrix_of(*t.matrix);
    }
    Matrix m = diagonal(t.scale.x, t.scale.y, t.scale.z);
    for (int axis = 0; axis < 3; ++axis) {
        m = product(rotation(static_cast<std::size_t>(axis), t.rotate[axis]), m);
    }
    for (int i = 0; i < 3; ++i) {
        m[static_cast<std::size_t>(i)][3] += t.translate[i];
    }
    return m;
}

inline Vector image(const Matrix& m, const glm::dvec3& p) {
    Vector r{};
    for (std::size_t i = 0; i < 3; ++i) {
        r[i] = m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z + m[i][3];
    }
    return r;
}

/// The largest entry of the linear part, or distance moved.
inline Real size_of(const Matrix& m, std::size_t first, std::size_t count) {
    Real size = 0;
    for (const auto& row : m) {
        for (std::size_t j = first; j < first + count; ++j) {
            size = std::max(size, std::abs(row[j]));
        }
    }
    return size;
}

} // namespace razor
