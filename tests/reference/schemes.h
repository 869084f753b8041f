// Ways to choose the surface that a ray sees, to be compared.
//
//   recursive   the definition (surface.h): brute force over the finest triangulation
//   projected   the same with footprints at the anchors' projections on the ray
//   walk        the same surface by stand-in blocks (walk.h)
//   finer-box   walk with boxes of only the finer vertices inside the block
//   unclosed    walk without the slivers between polylines
//   discrete    a block's level is whole: its weights rounded to 0 or 1; each block as it is at its level
//   patch       one level a patch, by its least footprint
//   camera      the recursive surface of one fixed viewpoint, for every ray
//   fixed:k     level k everywhere, k = 0 ... 9
//   paper       "Razor" (Djeu et al., TOG 2011), equations 1-6: inside the stretch of the ray that belongs to
//   a
//               pair of levels, fine vertices are blended towards the coarse mesh by their projection on the
//               ray; hits outside the stretch do not count. The blend in the direction that fits the growth
//   printed     the same with equation 6 as printed (fine at the end of the transition)
#pragma once

#include "tests/reference/intersect.h"
#include "tests/reference/surface.h"
#include "tests/reference/walk.h"

#include <memory>
#include <string>
#include <vector>

namespace razor::reference {

/// Rays of one origin and footprint.
class Tracer {
public:
    virtual ~Tracer() = default;
    virtual Hits trace(const Ray& ray) const = 0;
    /// What rays meet, where that is the same for all; else null.
    virtual const Soup* soup() const { return nullptr; }
};

/// What schemes are made from: built once a mesh.
struct Structures {
    explicit Structures(const Levels& levels, int side = 1);
    const Levels& levels;
    Blocks blocks, finer_boxes;
    std::vector<std::vector<Triangle>> by_level; // unclosed
    std::vector<Triangle> finest;                // closed
};

const std::vector<std::string>& scheme_names();
/// Throws std::invalid_argument on other names. Keeps a reference to the structures.
std::unique_ptr<Tracer> make_tracer(const std::string& scheme, const Structures& structures,
                                    const View& view);

/// The recursive surface's triangles, finest.
Soup recursive_soup(const Structures& structures, const Surface& surface);
/// Level k of the whole mesh.
Soup discrete_soup(const Levels& levels, int k);

} // namespace razor::reference
