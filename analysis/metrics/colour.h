// Colours as FLIP sees them: linear sRGB to CIE XYZ, to the opponent space YCxCz (linearised CIELAB: Zhang
// and Wandell 1997, Mahy et al. 1994), to CIELAB. X, Y and Z are relative to the white of the display (D65).
#pragma once

#include <array>
#include <cmath>

namespace analysis {

using Colour = std::array<float, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr double determinant(const Matrix& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// By Cramer's rule.
constexpr Matrix inverse(const Matrix& m) {
    const double d = determinant(m);
    Matrix out{};
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            const std::size_t r1 = (column + 1) % 3, r2 = (column + 2) % 3;
            const std::size_t c1 = (row + 1) % 3, c2 = (row + 2) % 3;
            out[row][column] = (m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]) / d;
        }
    }
    return out;
}

/// Linear sRGB to X/Xn, Y/Yn, Z/Zn, from the chromaticities of IEC 61966-2-1: each primary is scaled so that
/// R = G = B = 1 gives the white; then each row is divided by it, so that white is (1, 1, 1).
constexpr Matrix relative_xyz_matrix() {
    constexpr std::array<std::array<double, 2>, 3> primaries{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}};
    constexpr double white_x = 0.3127, white_y = 0.3290;
    Matrix m{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto [x, y] = primaries[c];
        m[0][c] = x / y;
        m[1][c] = 1;
        m[2][c] = (1 - x - y) / y;
    }
    const Matrix solve = inverse(m);
    const std::array<double, 3> white{white_x / white_y, 1, (1 - white_x - white_y) / white_y};
    std::array<double, 3> scale{};
    for (std::size_t c = 0; c < 3; ++c) {
        scale[c] = solve[c][0] * white[0] + solve[c][1] * white[1] + solve[c][2] * white[2];
    }
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t c = 0; c < 3; ++c) {
            m[row][c] *= scale[c] / white[row];
        }
    }
    return m;
}

inline constexpr Matrix xyz_of_rgb = relative_xyz_matrix();
inline constexpr Matrix rgb_of_xyz = inverse(xyz_of_rgb);

inline Colour multiply(const Matrix& m, const Colour& v) {
    Colour out{};
    for (std::size_t row = 0; row < 3; ++row) {
        out[row] = static_cast<float>(m[row][0]) * v[0] + static_cast<float>(m[row][1]) * v[1] +
                   static_cast<float>(m[row][2]) * v[2];
    }
    return out;
}

/// The luminance of linear sRGB, relative to white.
inline double luminance(double r, double g, double b) {
    return xyz_of_rgb[1][0] * r + xyz_of_rgb[1][1] * g + xyz_of_rgb[1][2] * b;
}

/// Linear sRGB to YCxCz: achromatic, red-green, blue-yellow. White is (100, 0, 0), black (-16, 0, 0).
inline Colour ycxcz_of_rgb(const Colour& rgb) {
    const Colour xyz = multiply(xyz_of_rgb, rgb);
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}

inline Colour rgb_of_ycxcz(const Colour& ycxcz) {
    const float y = (ycxcz[0] + 16) / 116;
    return multiply(rgb_of_xyz, {y + ycxcz[1] / 500, y, y - ycxcz[2] / 200});
}

/// Linear sRGB to CIE 1976 L*a*b*.
inline Colour lab_of_rgb(const Colour& rgb) {
    constexpr float delta = 6.0F / 29;
    Colour f = multiply(xyz_of_rgb, rgb);
    for (float& t : f) {
        t = t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0F / 29;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

inline Colour rgb_of_lab(const Colour& lab) {
    constexpr float delta = 6.0F / 29;
    const float y = (lab[0] + 16) / 116;
    Colour xyz{y + lab[1] / 500, y, y - lab[2] / 200};
    for (float& t : xyz) {
        t = t > delta ? t * t * t : 3 * delta * delta * (t - 4.0F / 29);
    }
    return multiply(rgb_of_xyz, xyz);
}

/// The Hunt effect: what is darker looks less colourful (a* and b* times L* / 100; Hunt 1952, as in FLIP).
inline Colour hunt(const Colour& lab) {
    return {lab[0], 0.01F * lab[0] * lab[1], 0.01F * lab[0] * lab[2]};
}

/// HyAB, for large colour differences: city blocks in lightness, Euclidean in chroma (Abasi et al. 2020).
inline float hyab(const Colour& a, const Colour& b) {
    const float da = a[1] - b[1], db = a[2] - b[2];
    return std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

} // namespace analysis
