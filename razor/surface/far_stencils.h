// Limit stencils by Far, where OpenSubdiv 3.5's Bfr cannot be trusted:
// - creases by Chaikin's rule: on some faces Bfr is off by 5e-4 of the cage's size (catmark_chaikin1.obj), at
// every
//   approximation level, where Far is exact;
// - faces round an interior point of two faces: Bfr crashes if there are creases near, and its cache confuses
// them.
#pragma once

#include "razor/scene/scene.h"

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace razor {

class FarStencils {
public:
    /// Refines around `faces` only; no other may be asked for.
    FarStencils(const Mesh& mesh, const std::vector<int>& faces, int approximation_level);
    ~FarStencils();

    /// Adds the weights of a point of a face (sub-face coordinates in [0,1]^2) to `weights[k]`: k = 0
    /// position, 1 d/du, 2 d/dv, 3 d2/du2, 4 d2/dudv, 5 d2/dv2. `row` says where in them a mesh point's
    /// weight lies. Any thread. Throws std::logic_error if a point that has a weight has no row.
    void add(int face, int sub, std::array<double, 2> uv, const std::unordered_map<int, int>& row,
             std::array<std::vector<double>, 6>& weights) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace razor
