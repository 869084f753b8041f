// Limit positions and normals from pages against Far's limit stencils, an independent path through
// OpenSubdiv, at equal approximation levels.
#include "meshes.h"
#include "patch_samples.h"

#include "razor/surface/refiner.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include <algorithm>
#include <memory>

namespace razor::test {
namespace {

namespace Far = OpenSubdiv::Far;

constexpr int level = 5;
constexpr int exponent = 2; // 5 x 5 points a patch
constexpr int side = (1 << exponent) + 1;

Samples far_samples(const Mesh& mesh, const Topology& topology) {
    const auto refiner = make_refiner(mesh);
    Far::TopologyRefiner::AdaptiveOptions adaptive(level);
    adaptive.useInfSharpPatch = true;
    refiner->RefineAdaptive(adaptive);
    const Far::PtexIndices ptex(*refiner);
    std::vector<double> s, t;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            s.push_back(static_cast<double>(i) / (side - 1));
            t.push_back(static_cast<double>(j) / (side - 1));
        }
    }
    using Factory = Far::LimitStencilTableFactoryReal<double>;
    Factory::LocationArrayVec locations;
    for (const PatchRecord& patch : topology.patches) {
        Factory::LocationArray where;
        where.ptexIdx = ptex.GetFaceId(patch.face) + patch.sub;
        where.numLocations = side * side;
        where.s = s.data();
        where.t = t.data();
        locations.push_back(where);
    }
    Far::PatchTableFactory::Options patches;
    patches.SetPatchPrecision<double>();
    patches.includeBaseLevelIndices = true;
    patches.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
    patches.useInfSharpPatch = true;
    patches.generateLegacySharpCornerPatches = false; // smooth corners stay smooth, as in Bfr
    const std::unique_ptr<const Far::PatchTable> patch_table(
        Far::PatchTableFactory::Create(*refiner, patches));
    const std::unique_ptr<const Far::LimitStencilTableReal<double>> table(
        Factory::Create(*refiner, locations, nullptr, patch_table.get()));
    Samples samples;
    for (int i = 0; i < table->GetNumStencils(); ++i) {
        const auto stencil = table->GetLimitStencil(i);
        glm::dvec3 p(0), du(0), dv(0);
        for (int k = 0; k < stencil.GetSize(); ++k) {
            const glm::dvec3 x = mesh.points[static_cast<std::size_t>(stencil.GetVertexIndices()[k])];
            p += stencil.GetWeights()[k] * x;
            du += stencil.GetDuWeights()[k] * x;
            dv += stencil.GetDvWeights()[k] * x;
        }
        samples.position.push_back(p);
        samples.du.push_back(du);
        samples.dv.push_back(dv);
    }
    return samples;
}

struct Errors {
    double position = 0, single_position = 0, normal = 0,
           single_normal = 0; // of the cage size; sine of the angle
    double hull = 0;          // part of the control box's size outside it
    int without_normal = 0;
};

/// The length of the cross product against the derivatives' lengths, or 0 where either vanishes against the
/// cage.
double normal_strength(const glm::dvec3& du, const glm::dvec3& dv, double size) {
    const double a = glm::length(du), b = glm::length(dv);
    return std::min(a, b) < 1e-4 * size ? 0 : glm::length(glm::cross(du, dv)) / (a * b);
}

double normal_error(const glm::dvec3& du0, const glm::dvec3& dv0, const glm::dvec3& du1,
                    const glm::dvec3& dv1) {
    const glm::dvec3 n0 = glm::normalize(glm::cross(du0, dv0)), n1 = glm::normalize(glm::cross(du1, dv1));
    return glm::length(n0 - n1);
}

Errors compare(const Mesh& mesh) {
    const Topology topology = analyse_topology(mesh);
    const Samples reference = far_samples(mesh, topology);
    PagePool pool(mesh, topology, level);
    const double size = extent(mesh);
    Errors worst;
    std::size_t at = 0;
    for (const PatchRecord& patch : topology.patches) {
        const FaceRecord& face = topology.faces[static_cast<std::size_t>(patch.face)];
        glm::dvec3 low(1e300), high(-1e300);
        for (int c = 0; c < face.control_count; ++c) {
            const int point = topology.controls[static_cast<std::size_t>(face.control_first + c)];
            low = glm::min(low, mesh.points[static_cast<std::size_t>(point)]);
            high = glm::max(high, mesh.points[static_cast<std::size_t>(point)]);
        }
        const Samples exact = pool.block(patch, exponent), single = pool.block(patch, exponent, true);
        for (std::size_t i = 0; i < exact.position.size(); ++i, ++at) {
            const glm::dvec3 p = reference.position[at];
            worst.position = std::max(worst.position, glm::length(exact.position[i] - p) / size);
            worst.single_position =
                std::max(worst.single_position, glm::length(single.position[i] - p) / size);
            const glm::dvec3 outside = glm::max(low - exact.position[i], exact.position[i] - high);
            const double largest = std::max({outside.x, outside.y, outside.z});
            worst.hull = std::max(worst.hull, largest / glm::length(high - low));
            if (normal_strength(reference.du[at], reference.dv[at], size) < 1e-2) {
                ++worst.without_normal;
                continue;
            }
            worst.normal = std::max(
                worst.normal, normal_error(exact.du[i], exact.dv[i], reference.du[at], reference.dv[at]));
            worst.single_normal =
                std::max(worst.single_normal,
                         normal_error(single.du[i], single.dv[i], reference.du[at], reference.dv[at]));
        }
    }
    return worst;
}

void check(const Mesh& mesh) {
    SCOPED_TRACE(mesh.name);
    const Errors e = compare(mesh);
    fmt::print("  {:28} position {:.1e} single {:.1e}, normal {:.1e} single {:.1e}, outside hull {:.1e}, no "
               "normal {}\n",
               mesh.name, e.position, e.single_position, e.normal, e.single_normal, e.hull, e.without_normal);
    EXPECT_LT(e.position, 1e-6);
    EXPECT_LT(e.single_position, 1e-5);
    // Derivative weights are rounded to single precision, and a direction is accepted down to a hundredth of
    // the derivatives' product: 1e-7 * (cage size / least derivative) * 100.
    EXPECT_LT(e.normal, 1e-3);
    EXPECT_LT(e.single_normal, 1e-2);
    EXPECT_LT(e.hull, 1.0 / 256);
}

TEST(LimitSurface, EqualsFarLimitStencilsOnHardCages) {
    for (const Mesh& mesh : hard_meshes()) {
        validate_mesh(mesh);
        check(mesh);
    }
}

TEST(LimitSurface, EqualsFarLimitStencilsOnOpenSubdivsShapes) {
    if (!have_shared_scenes()) {
        GTEST_SKIP() << "no shared scenes at " << RAZOR_SHARED_SCENES;
    }
    for (const Mesh& mesh : osd_meshes()) {
        if (mesh.scheme == Scheme::catmull_clark) {
            check(mesh);
        }
    }
}

} // namespace
} // namespace razor::test
