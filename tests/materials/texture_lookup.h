// Textures looked up in double, and floors that show them to single rays.
#pragma once

#include "tests/materials/floor.h"

#include <glm/mat2x2.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <functional>
#include <random>
#include <string>

namespace razor::test {

/// All levels random: no level stands for another.
Texture random_texture(int width, int height, unsigned seed);
Texture plain_texture(const glm::vec3& colour);

/// `area`: in mapped texture coordinates, of what is asked for.
glm::dvec3 colour_at(const Texture& t, const glm::dvec2& at, double area);
/// Of its finest level, from 0 to 1.
double opacity_at(const Texture& t, const glm::dvec2& at);
glm::dvec2 mapped_by(const TextureMap& map, const glm::dvec2& uv);

/// Texture coordinates from x and z of a floor.
struct Layout {
    glm::dmat2 linear{1};
    glm::dvec2 offset{0};
    glm::dvec2 operator()(const glm::dvec3& p) const { return linear * glm::dvec2(p.x, p.z) + offset; }
};
Layout random_layout(std::mt19937& random);
/// Each of its points has a coordinate, by where it is. What corners and boundaries do is left alone.
Mesh laid_out(Mesh mesh, const Layout& layout);

/// From -1 to 1 in x and z, of n x n faces seen from above; `height` of points inside.
Mesh square(int n, Scheme scheme, const std::function<double(int, int)>& height = {});

/// One pixel that sees the mesh with that texture.
Scene scene_with(const Mesh& mesh, const Texture& texture, const TextureMap& map = {.texture = 0});

/// Of the one pixel; directions are rounded to about as much.
inline constexpr double pixel_degrees = 1e-5;

/// What one ray meets.
struct Met {
    glm::dvec3 position, albedo, normal, beauty;
    double depth;
};
Met meet(Scene& scene, const glm::dvec3& from, const glm::dvec3& target);
/// Of three planes.
glm::dvec3 three(const Film& film, const char* x, const char* y, const char* z, std::size_t pixel = 0);

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance, const std::string& what);

/// Of chance, on a floor and above it.
class Places {
public:
    explicit Places(unsigned seed) : random(seed) {}
    double next() { return static_cast<double>(random()) / 2147483648.0 - 1.0; }
    glm::dvec3 on(double extent) {
        const double x = extent * next(), z = extent * next();
        return {x, 0, z};
    }
    /// At most so many degrees from upright.
    glm::dvec3 above(double degrees) {
        const double a = std::cos(glm::radians(degrees)), y = a + (1 - a) * std::abs(next());
        const double phi = 3.14159 * next(), s = std::sqrt(1 - y * y);
        return {s * std::cos(phi), y, s * std::sin(phi)};
    }
    std::mt19937 random;
};

} // namespace razor::test
