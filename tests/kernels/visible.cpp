// How much surface a picture shows, by hand and beside the area of a plane.
#include "razor/native/visible.h"

#include "razor/frame/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace razor::test {
namespace {

/// All pixels see a surface with this normal.
Film film_of(int width, int height, double x, double y, double z) {
    Film film = make_film(width, height);
    const auto fill = [&film](const char* name, double value) {
        film.find(name)->values.assign(film.pixel_count(), static_cast<float>(value));
    };
    fill("depth.Z", 2);
    fill("normal.X", x);
    fill("normal.Y", y);
    fill("normal.Z", z);
    return film;
}

Camera looking_ahead(double fov) {
    Camera c;
    c.position = glm::dvec3(0);
    c.target = glm::dvec3(0, 0, -1);
    c.up = glm::dvec3(0, 1, 0);
    c.fov_degrees = fov;
    return c;
}

Settings of_size(int width, int height) {
    Settings s;
    s.width = width;
    s.height = height;
    return s;
}

TEST(Visible, ByHand) {
    const Camera narrow = looking_ahead(0.1);
    const Settings one = of_size(1, 1);
    EXPECT_NEAR(visible_surface(film_of(1, 1, 0, 0, 1), narrow, one).squares, 1, 1e-6);
    EXPECT_NEAR(visible_surface(film_of(1, 1, 0, 0, -1), narrow, one).squares, 1, 1e-6);
    EXPECT_NEAR(visible_surface(film_of(1, 1, std::sqrt(0.75), 0, 0.5), narrow, one).squares, 2, 1e-6);
    EXPECT_EQ(visible_surface(film_of(1, 1, 1, 0, 0), narrow, one).squares, most_squares);
    Film film = film_of(2, 1, 0, 0, 1);
    film.find("depth.Z")->values[1] = std::numeric_limits<float>::infinity();
    const VisibleSurface half = visible_surface(film, narrow, of_size(2, 1));
    EXPECT_EQ(half.pixels, 1);
    EXPECT_NEAR(half.squares, 1, 1e-6);
    // Two pixels side by side: their centres are 45 degrees to the left and to the right.
    const Camera wide = looking_ahead(90);
    const double side = std::sqrt(0.5);
    EXPECT_NEAR(visible_surface(film_of(2, 1, side, 0, side), wide, of_size(2, 1)).squares, 1 + most_squares,
                1e-4);
}

// A floor, in squares of what is a pixel large in the middle of the film.
TEST(Visible, AFloorIsAsLargeAsItIs) {
    Camera camera = looking_ahead(20);
    camera.target = glm::dvec3(0, -1, -3); // of a floor at height -1
    const int side = 200;
    const double squares = visible_surface(film_of(side, side, 0, 1, 0), camera, of_size(side, side)).squares;
    // Its area by the corners of pixels, over the square of a footprint at each pixel's distance.
    const View view = view_of(camera);
    const FilmExtent film = film_extent(camera, of_size(side, side));
    const double footprint = pixel_footprint(camera, of_size(side, side));
    const auto hit = [&](double column, double row) {
        const glm::dvec3 way = view.forward + view.right * (film.half_width * (2 * column / side - 1)) +
                               view.up * (film.half_height * (1 - 2 * row / side));
        return way / -way.y;
    };
    double area = 0;
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const glm::dvec3 a = hit(column, row), b = hit(column + 1, row), c = hit(column, row + 1),
                             d = hit(column + 1, row + 1), m = hit(column + 0.5, row + 0.5);
            const auto twice = [](glm::dvec3 u, glm::dvec3 v) { return std::abs(u.x * v.z - u.z * v.x); };
            const double way = std::sqrt(m.x * m.x + 1 + m.z * m.z) * footprint;
            area += (twice(b - a, c - a) + twice(b - d, c - d)) / 2 / (way * way);
        }
    EXPECT_NEAR(squares / area, 1, 0.02);
}

} // namespace
} // namespace razor::test
