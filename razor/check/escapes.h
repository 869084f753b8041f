// Rays from inside closed bodies: none may escape, whatever level of detail it asks for.
#pragma once

#include "razor/check/tracer.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace razor::check {

/// Whether what all rays of one field see is one surface. Else it has no definition to compare with.
constexpr bool sees_one_surface(Lod lod) {
    return lod != Lod::discrete && lod != Lod::patch && lod != Lod::paper;
}

struct EscapeOptions {
    std::int64_t rays = 1'000'000;
    /// Hits of so many rays (at most all) are compared with those of the surface by definition. Only where
    /// there is one: see sees_one_surface().
    std::int64_t compared = 0;
    int rays_an_origin = 1000;
    /// What rays ask for; without them, random: growths of -1 to 10, bases from half a finest edge to the
    /// coarsest level.
    std::optional<double> growth; // kernels see at most gradation_cap either way
    std::optional<double> base;   // in target edges of the finest level, times 2^-1/2 ... 2^1/2
    unsigned seed = 1;
    std::function<void(double fraction)> progress;
    const std::atomic<bool>* cancel = nullptr;
};

/// One that went wrong, to be tried again: in world units, from the scene's centre (Frame::origin).
struct BadRay {
    Ray ray;
    float t = -1;         // of its hit; -1: none
    double expected = -1; // of the surface's nearest crossing; -1: none
};

struct EscapeReport {
    std::int64_t rays = 0, origins = 0;
    std::int64_t escapes = 0; // rays that hit nothing ...
    std::int64_t holes = 0;   // ... of which the surface by definition lets so many through as well
    std::int64_t compared = 0, different = 0;
    double worst = 0;   // largest distance of a hit from the nearest crossing, in its bound
    double seconds = 0; // in kernels
    std::vector<BadRay> escaped, differing; // the first few
    std::int64_t patches = 0, vertices = 0; // of the finest triangulation
    bool cancelled = false;
};

/// How many roundings a hit may be off: see SeenSurface::crossings. The longest chain of single-precision
/// operations from a vertex's anchor to a hit's distance has two for each of at most 8 means of parents and
/// 12 for the weights, 4 to project a vertex, and 6 to divide by the determinant.
inline constexpr double hit_roundings = 40;

/// Shoots rays from inside the bodies of a frame whose meshes are all closed, through its own kernels; opens
/// everything that is lazy first. An origin is inside where an odd number of crossings of what it sees says
/// so along each of three directions; for schemes under which rays of one field see no one surface, also of
/// every level as a whole. Fewer origins than asked for, or none
/// (report.origins 0), are found in bodies that are very thin. Worker 0 alone; call before anything is
/// rendered.
EscapeReport shoot_from_inside(Frame& frame, const KernelTable& kernels, Lod lod,
                               const EscapeOptions& options);

} // namespace razor::check
