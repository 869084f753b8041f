// Patches of bilinear meshes, which have no limit surface: planar faces stay flat, others become bilinear
// quads.
#pragma once

#include "razor/surface/adjacency.h"
#include "razor/surface/topology.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace razor {

/// A face is planar if no corner is farther from its mean plane than this part of the face's extent. Flat
/// patches keep their corners and edges exactly, so the tolerance moves only the inside of a face, and opens
/// no crack.
inline constexpr double planar_tolerance = 1e-4;

/// The polygon's corners projected along the axis of its largest area, turned to be counter-clockwise; empty
/// if it is not planar. Triangles and polygons without area are planar.
std::vector<glm::dvec2> project_if_planar(std::span<const glm::dvec3> polygon);

/// Patches of every drawn face, spokes of n-gons that are not flat, and FaceRecords whose controls are the
/// corners. `diced`: planar convex faces are cut as others are.
void append_bilinear_patches(const Mesh& mesh, const Adjacency& adjacency, const std::vector<bool>& drawn,
                             bool diced, Topology& topology);

} // namespace razor
