// Affine maps in double precision, and the transform of one node as its author states it.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <utility>

namespace razor {

/// p -> linear p + translation. `linear` is stored by columns, as glm does: column i is the image of axis i.
struct Affine {
    glm::dmat3 linear{1};
    glm::dvec3 translation{0};

    glm::dvec3 operator()(const glm::dvec3& p) const { return linear * p + translation; }
    /// `b` first, then `a`.
    friend Affine operator*(const Affine& a, const Affine& b) {
        return {a.linear * b.linear, a(b.translation)};
    }
    bool operator==(const Affine&) const = default;
};

/// The map back. `a` must not be degenerate; each entry is then off by some units of rounding times the
/// condition number, relative to the largest.
Affine inverse(const Affine& a);

/// Largest first; each to a few units of rounding relative to itself where the columns are independent
/// (one-sided Jacobi: Hestenes, J. SIAM 6(1), 1958). NaN where an entry is not finite.
glm::dvec3 singular_values(const glm::dmat3& m);

/// The smallest singular value is less than this times the largest: what the map does to a surface could no
/// longer be undone in single precision.
inline constexpr double least_relative_scale = 1e-9;
bool is_degenerate(const glm::dmat3& m);

/// Turns right hands into left ones.
bool is_mirrored(const glm::dmat3& m);

/// The transform of one node, relative to its parent: p -> translate + Rz Ry Rx (scale p), or a matrix
/// instead of all three. What moves in time is this; world matrices are derived from it.
struct Transform {
    glm::dvec3 scale{1, 1, 1};     // not zero; negative mirrors
    glm::dvec3 rotate{0, 0, 0};    // degrees, about x, then y, then z; quarter turns are exact
    glm::dvec3 translate{0, 0, 0}; // units of the parent
    std::optional<Affine> matrix{};
};

Affine to_affine(const Transform& transform);

/// Cosine and sine of an angle in degrees, exact at multiples of 90.
std::pair<double, double> cos_sin_degrees(double angle);

} // namespace razor
