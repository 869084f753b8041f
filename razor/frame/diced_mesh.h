// The surfaces of a frame as meshes: what camera rays see, of all patches, seen or not.
#pragma once

#include "razor/frame/frame.h"

#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace razor {

/// One instance. Polygons, counter-clockwise seen from outside: triangles of the diced blocks, with further
/// corners on their edges where a neighbour is finer, so that neighbours share all vertices of an edge.
struct DicedInstance {
    int mesh = 0;                   // of Scene::meshes
    std::vector<glm::dvec3> points; // world coordinates
    std::vector<glm::vec3> normals; // unit
    struct Corner {
        int point = 0, normal = 0;
    };
    std::vector<int> face_sizes;
    std::vector<Corner> corners; // concatenated over faces
};

/// Of a frame whose blocks are diced (Frame::dice_all): every vertex where the camera's field puts it
/// (razor/kernels/morph.h), in double precision; vertices that have gone from the camera's view appear only
/// where something beside them has not. Instances in the scene's order. `look` is called now and then, far
/// more often than ten times a second, and may throw to end the work.
std::vector<DicedInstance> diced_mesh(
    Frame& frame, const std::function<void()>& look = [] {});

} // namespace razor
