#include "razor/surface/refiner.h"

#include "razor/scene/error.h"

#include <fmt/format.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/sdc/options.h>

namespace razor {
namespace {

namespace Sdc = OpenSubdiv::Sdc;
namespace Far = OpenSubdiv::Far;

Sdc::Options subdivision_options(const Mesh& mesh) {
    Sdc::Options options;
    switch (mesh.boundary) {
    case BoundaryInterpolation::none:
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
        break;
    case BoundaryInterpolation::edge_only:
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        break;
    case BoundaryInterpolation::edge_and_corner:
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
        break;
    }
    options.SetCreasingMethod(mesh.crease_method == CreaseMethod::chaikin ? Sdc::Options::CREASE_CHAIKIN
                                                                          : Sdc::Options::CREASE_UNIFORM);
    options.SetTriangleSubdivision(mesh.triangles == TriangleSubdivision::smooth
                                       ? Sdc::Options::TRI_SUB_SMOOTH
                                       : Sdc::Options::TRI_SUB_CATMARK);
    return options;
}

} // namespace

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Mesh& mesh) {
    std::vector<int> crease_points;
    std::vector<float> crease_weights;
    for (const Crease& crease : mesh.creases) {
        crease_points.insert(crease_points.end(), {crease.v0, crease.v1});
        crease_weights.push_back(crease.sharpness);
    }
    std::vector<int> corner_points;
    std::vector<float> corner_weights;
    for (const Corner& corner : mesh.corners) {
        corner_points.push_back(corner.vertex);
        corner_weights.push_back(corner.sharpness);
    }
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(mesh.points.size());
    descriptor.numFaces = static_cast<int>(mesh.face_sizes.size());
    descriptor.numVertsPerFace = mesh.face_sizes.data();
    descriptor.vertIndicesPerFace = mesh.face_vertices.data();
    descriptor.numCreases = static_cast<int>(crease_weights.size());
    descriptor.creaseVertexIndexPairs = crease_points.data();
    descriptor.creaseWeights = crease_weights.data();
    descriptor.numCorners = static_cast<int>(corner_weights.size());
    descriptor.cornerVertexIndices = corner_points.data();
    descriptor.cornerWeights = corner_weights.data();
    descriptor.numHoles = static_cast<int>(mesh.holes.size());
    descriptor.holeIndices = mesh.holes.data();

    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    Factory::Options options(Sdc::SCHEME_CATMARK, subdivision_options(mesh));
    std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(descriptor, options));
    if (!refiner) {
        throw UserError(
            fmt::format("mesh '{}': OpenSubdiv refuses its topology; render it as bilinear", mesh.name));
    }
    return refiner;
}

std::vector<bool> faces_with_limit_surface(const Mesh& mesh) {
    std::vector<bool> drawn(mesh.face_sizes.size(), true);
    for (const int hole : mesh.holes) {
        drawn[static_cast<std::size_t>(hole)] = false;
    }
    if (mesh.scheme == Scheme::catmull_clark && mesh.boundary == BoundaryInterpolation::none) {
        const std::unique_ptr<Far::TopologyRefiner> refiner = make_refiner(mesh);
        const OpenSubdiv::Bfr::RefinerSurfaceFactory<> factory(*refiner);
        for (std::size_t f = 0; f < drawn.size(); ++f) {
            drawn[f] = drawn[f] && factory.FaceHasLimitSurface(static_cast<int>(f));
        }
    }
    return drawn;
}

} // namespace razor
