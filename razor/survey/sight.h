// What a ray hit, in the words of the scene: mesh, face, place on it, level of detail.
#pragma once

#include "razor/frame/frame.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace razor {

/// A hit as kernels name it: see SeeArguments.
struct NamedHit {
    float t = 0, u = 0, v = 0;
    std::int32_t patch = -1, triangle = -1, block = -1;
};

/// Faces are numbered as the mesh has them. A quad's patch has the face's corners in their order; an n-gon,
/// to be subdivided or not planar, has a patch a corner: from it to the middle of the edge that follows, the
/// face's centre and the middle of the edge before. Planar polygons of bilinear meshes that are triangles or
/// not convex have a flat triangle each, in the order in which they are cut. (u, v) on a patch: corner 0 is
/// (0, 0), 1 (1, 0), 2 (1, 1), 3 (0, 1). Subdivided and bilinear patches have the surface's own parameters
/// there, and inside a triangle of the level seen what is linear between its vertices'; flat ones are linear
/// in triangles 0-1-2 and 0-2-3, of which a flat triangle is the first.
struct Sight {
    std::int32_t mesh = -1, instance = -1, face = -1, part = -1;
    double u = -1, v = -1;   // off by half an ulp of the barycentric weights, about 1e-7
    std::int32_t patch = -1; // in its mesh
    std::int32_t block = -1; // row by row in its patch and level
    int level = 0;           // 0: the finest of the instance
    int absolute = 0;        // edges of about 2^absolute in the frame's unit
};

/// Of a hit (hit.patch >= 0) whose block is in memory now.
Sight sight_of(Frame& frame, const NamedHit& hit);

/// Edge length that camera rays ask for at a point (scene coordinates, the frame's unit): what levels are
/// chosen by. 0 where all ask for the finest.
double asked_edge(const FrameHeader& frame, const glm::dvec3& point);

} // namespace razor
