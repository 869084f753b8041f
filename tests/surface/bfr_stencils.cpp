#include "bfr_stencils.h"

#include "razor/surface/refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace razor::test {

namespace Bfr = OpenSubdiv::Bfr;

BfrStencils::BfrStencils(const Mesh& mesh, int level)
    : refiner_(make_refiner(mesh)),
      factory_(
          *refiner_,
          Bfr::SurfaceFactory::Options().EnableCaching(false).SetApproxLevelSmooth(level).SetApproxLevelSharp(
              level)) {}

PointWeights BfrStencils::at(const PatchRecord& patch, std::array<double, 2> uv) {
    if (face_ != patch.face) {
        face_ = patch.face;
        EXPECT_TRUE(factory_.InitVertexSurface(patch.face, &surface_));
        points_.resize(static_cast<std::size_t>(surface_.GetNumControlPoints()));
        surface_.GetControlPointIndices(points_.data());
    }
    double scale = 1;
    if (surface_.GetFaceSize() != 4) {
        const std::array<double, 2> normalized = uv;
        surface_.GetParameterization().ConvertNormalizedSubFaceToCoord(patch.sub, normalized.data(),
                                                                       uv.data());
        scale = 0.5;
    }
    std::array<std::vector<double>, 3> weights;
    weights.fill(std::vector<double>(points_.size()));
    surface_.EvaluateStencil(uv.data(), weights[0].data(), weights[1].data(), weights[2].data());
    PointWeights out;
    for (std::size_t row = 0; row < weights.size(); ++row) {
        for (std::size_t k = 0; k < points_.size(); ++k) {
            out[row][points_[k]] += (row == 0 ? 1 : scale) * weights[row][k];
        }
    }
    return out;
}

std::array<double, 3> differences(PointWeights exact, const Topology& topology, const FaceRecord& face,
                                  const std::vector<float>& block, const std::vector<float>* derivative,
                                  std::size_t column) {
    const auto controls = static_cast<std::size_t>(face.control_count);
    const std::size_t row = block.size() / controls;
    std::array<double, 3> worst{};
    for (std::size_t k = 0; k < (derivative == nullptr ? 1U : 3U); ++k) {
        for (std::size_t c = 0; c < controls; ++c) {
            const int point = topology.controls[static_cast<std::size_t>(face.control_first) + c];
            exact[k][point] -= static_cast<double>(k == 0 ? block[c * row + column]
                                                          : (*derivative)[(2 * c + k - 1) * row + column]);
        }
        for (const auto& [point, difference] : exact[k]) {
            worst[k] = std::max(worst[k], std::abs(difference));
        }
    }
    return worst;
}

} // namespace razor::test
