// A rendered picture: named planes of floats or of whole numbers, rows from the top.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
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
    /// Of planes whose numbers name things, as many, instead of `values`: floats tell apart no more than
    /// 2^24.
    std::vector<std::uint32_t> ids{};

    /// The value, or the number that is a name; of no_id -1.
    double at(std::size_t pixel) const;
};

/// Where there is nothing that has a name.
inline constexpr std::uint32_t no_id = std::numeric_limits<std::uint32_t>::max();

/// Where a film lies in the whole picture, and that one's size, in pixels from its top left corner.
struct PictureWindow {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(const PictureWindow&) const = default;
};

/// What a picture was taken by, as OpenEXR files say it: matrices by rows that a row (x, y, z, 1) of world
/// coordinates is multiplied by from the left. Camera coordinates are left-handed: x to the right, y up, z
/// along the line of sight. Normalised device coordinates (after division by w) are (0, 0) and (1, 1) in the
/// whole picture's upper left and lower right corners, z is -1 over the depth (perspective) or the
/// depth: it rises with it.
struct PictureCamera {
    std::array<float, 16> world_to_camera{}, world_to_ndc{};
    float screen_width = 1; // of the film at distance 1, where the projection is perspective

    bool operator==(const PictureCamera&) const = default;
};

struct Film {
    int width = 0, height = 0; // pixels
    std::vector<Plane> planes;
    std::optional<PictureWindow> window; // of a part of a picture
    std::optional<PictureCamera> camera; // where it is known

    Film() = default;
    Film(int width, int height) : width(width), height(height) {}

    std::size_t pixel_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    /// Adds a plane of zeros; the reference holds until the next plane is added.
    Plane& add(std::string_view name);
    /// Likewise one of names, all no_id.
    Plane& add_ids(std::string_view name);
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
