#include "razor/surface/far_stencils.h"

#include "razor/surface/refiner.h"

#include <fmt/format.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include <cmath>
#include <stdexcept>

namespace razor {

namespace Far = OpenSubdiv::Far;

struct FarStencils::Impl {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::unique_ptr<const Far::PatchTable> patches;
    std::unique_ptr<const Far::StencilTableReal<double>> stencils; // of every point of every patch
    std::unique_ptr<const Far::PatchMap> map;
    std::unique_ptr<const Far::PtexIndices> ptex;
};

FarStencils::FarStencils(const Mesh& mesh, const std::vector<int>& faces, int approximation_level)
    : impl_(std::make_unique<Impl>()) {
    Impl& i = *impl_;
    i.refiner = make_refiner(mesh);
    Far::TopologyRefiner::AdaptiveOptions adaptive(approximation_level);
    adaptive.useInfSharpPatch = true;
    i.refiner->RefineAdaptive(adaptive, Far::ConstIndexArray(faces.data(), static_cast<int>(faces.size())));
    i.ptex = std::make_unique<const Far::PtexIndices>(*i.refiner);

    Far::PatchTableFactory::Options patch_options;
    patch_options.SetPatchPrecision<double>();
    patch_options.includeBaseLevelIndices = true;
    patch_options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    patch_options.useInfSharpPatch = true;
    patch_options.generateLegacySharpCornerPatches = false; // smooth corners stay smooth, as in Bfr
    i.patches.reset(Far::PatchTableFactory::Create(
        *i.refiner, patch_options, Far::ConstIndexArray(faces.data(), static_cast<int>(faces.size()))));
    i.map = std::make_unique<const Far::PatchMap>(*i.patches);

    using Factory = Far::StencilTableFactoryReal<double>;
    Factory::Options stencil_options;
    stencil_options.generateIntermediateLevels = true;
    stencil_options.generateControlVerts = true;
    stencil_options.generateOffsets = true;
    i.stencils.reset(Factory::Create(*i.refiner, stencil_options));
    if (const auto* local = i.patches->GetLocalPointStencilTable<double>();
        local && local->GetNumStencils() > 0) {
        i.stencils.reset(Factory::AppendLocalPointStencilTable(*i.refiner, i.stencils.get(), local));
    }
}

FarStencils::~FarStencils() = default;

void FarStencils::add(int face, int sub, std::array<double, 2> uv, const std::unordered_map<int, int>& row,
                      std::array<std::vector<double>, 6>& weights) const {
    const Far::PatchTable::PatchHandle* patch =
        impl_->map->FindPatch(impl_->ptex->GetFaceId(face) + sub, uv[0], uv[1]);
    if (patch == nullptr) {
        throw std::logic_error(fmt::format("face {} has no patch at ({}, {})", face, uv[0], uv[1]));
    }
    std::array<std::array<double, 20>, 6> basis{};
    impl_->patches->EvaluateBasis(*patch, uv[0], uv[1], basis[0].data(), basis[1].data(), basis[2].data(),
                                  basis[3].data(), basis[4].data(), basis[5].data());
    const Far::ConstIndexArray patch_points = impl_->patches->GetPatchVertices(*patch);
    for (int c = 0; c < patch_points.size(); ++c) {
        const Far::StencilReal<double> stencil = impl_->stencils->GetStencil(patch_points[c]);
        for (int k = 0; k < stencil.GetSize(); ++k) {
            const double weight = stencil.GetWeights()[k];
            const auto found = row.find(stencil.GetVertexIndices()[k]);
            if (found == row.end()) {
                if (std::abs(weight) > 1e-12) {
                    throw std::logic_error(
                        fmt::format("face {} depends on point {}, which its control list lacks", face,
                                    stencil.GetVertexIndices()[k]));
                }
                continue;
            }
            for (std::size_t d = 0; d < weights.size(); ++d) {
                weights[d][static_cast<std::size_t>(found->second)] +=
                    weight * basis[d][static_cast<std::size_t>(c)];
            }
        }
    }
}

} // namespace razor
