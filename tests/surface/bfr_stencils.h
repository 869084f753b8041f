// OpenSubdiv's own stencils of a face, as Bfr evaluates them point by point: what pages are to hold.
#pragma once

#include "razor/surface/topology.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <array>
#include <map>
#include <memory>
#include <optional>

namespace razor::test {

/// Weights by mesh point: position, d/du, d/dv, by sub-face coordinates.
using PointWeights = std::array<std::map<int, double>, 3>;

class BfrStencils {
public:
    /// Of the mesh's faces that have a limit surface, at this approximation level.
    BfrStencils(const Mesh& mesh, int level);

    PointWeights at(const PatchRecord& patch, std::array<double, 2> uv);

private:
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
    OpenSubdiv::Bfr::RefinerSurfaceFactory<> factory_;
    int face_ = -1; // of which these are
    OpenSubdiv::Bfr::Surface<double> surface_;
    std::vector<int> points_;
};

/// The largest differences between those and what pages say there, `column` being the point's in theirs:
/// position, d/du, d/dv.
std::array<double, 3> differences(PointWeights exact, const Topology& topology, const FaceRecord& face,
                                  const std::vector<float>& block, const std::vector<float>* derivative,
                                  std::size_t column);

} // namespace razor::test
