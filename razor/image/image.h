// A rendered picture: named planes of floats, rows from the top.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace razor {

/// One channel. Names follow OpenEXR: "R", "G", "B" are the beauty; layers are "normal.X", "depth.Z",
/// "albedo.R", ...
struct Plane {
    std::string name;
    std::vector<float> values; // width * height
};

struct Film {
    int width = 0, height = 0; // pixels
    std::vector<Plane> planes;

    Film() = default;
    Film(int width, int height) : width(width), height(height) {}

    std::size_t pixel_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    /// Adds a plane of zeros; the reference holds until the next plane is added.
    Plane& add(std::string_view name);
    /// The plane of that name, or null.
    const Plane* find(std::string_view name) const;
    Plane* find(std::string_view name);
};

/// The planes every frame has: beauty R G B (linear radiance), normal.X normal.Y normal.Z (world space; zero
/// where nothing is hit), depth.Z (distance along the ray, world units; infinite where nothing is hit),
/// albedo.R albedo.G albedo.B.
Film make_film(int width, int height);

/// Text that files carry: name and value, for example {"razor.config", "..."}.
using ImageAttributes = std::vector<std::pair<std::string, std::string>>;

} // namespace razor
