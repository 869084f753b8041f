// Triangles as a ray sees them, and what closes them to the last bit.
//
// A straight edge that one side has as one piece and the other in several is a gap as wide as rounding:
// points computed to lie at the mean of their parents, then sheared into the ray's frame, are not on the
// line. Edge functions of a common ancestor do not mend it where a border folds in the ray's projection.
// Instead the gap belongs to the surface: it is filled with the fan of triangles between both polylines,
// which closes the complex combinatorially, whatever the positions. Crossings are then even along every line,
// folded or not. A hit in such a sliver lies on its longest side; its barycentric coordinates are noise.
//
// The polyline that all sides agree on is the *finest* one: the level-0 edges of the curve (or of the row of
// the patch's grid). A coarse edge is halved down to it; a hanging sub-edge reaches up to it. Both need only
// the ends of one edge. The coarsest flat ancestor would do as well but is no local quantity: whether an edge
// is flat for this ray depends on vertices far outside the block that asks.
#pragma once

#include "tests/reference/levels.h"

#include <functional>

namespace razor::reference {

struct Triangle {
    std::array<int, 3> points;
    int patch, level;
    int i, j;    // the quad's corner (0,0), in finest steps
    int which;   // 0: (00, 10, 11), 1: (00, 11, 01)
    bool sliver; // fills a gap: collinear but for rounding
};

struct Soup {
    std::vector<glm::dvec3> points;
    std::vector<Triangle> triangles;
};

/// Number of a vertex among the soup's points.
using PointOf = std::function<int(int vertex)>;

/// Quads [i, i_end) x [j, j_end) of a patch at `level`, in finest steps. `close`: fill the gaps along the
/// rectangle's four sides.
struct Rectangle {
    int patch, level;
    int i, j, i_end, j_end;
};
void draw(const Levels& levels, const Rectangle& r, bool close, const PointOf& point, Soup& soup);

/// Every patch at level min(k, its coarsest); points are numbered as the vertices.
std::vector<Triangle> draw_level(const Levels& levels, int k, bool close);

/// Edges (by their ends' bits) that an odd number of triangles have: 0 where the surface is closed for every
/// ray.
int open_edges(const Soup& soup);

} // namespace razor::reference
