// Small cages with random faces and tags, most of them not manifold: each is rendered or refused in one line,
// weights are finite, limit points lie in the hull, and manifold cages have no gap between patches.
#include "meshes.h"
#include "patch_samples.h"

#include "razor/scene/error.h"
#include "razor/surface/adjacency.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace razor::test {
namespace {

class CageMaker {
public:
    explicit CageMaker(unsigned seed) : random_(seed) {}

    Mesh make() {
        const int points = 4 + below(10), count = 1 + below(10);
        std::vector<std::vector<int>> faces;
        for (int f = 0; f < count; ++f) {
            faces.push_back(face(points, faces));
        }
        Mesh mesh = cage(points, faces);
        mesh.boundary = static_cast<BoundaryInterpolation>(below(3));
        mesh.crease_method = below(4) == 0 ? CreaseMethod::chaikin : CreaseMethod::normal;
        mesh.triangles = below(4) == 0 ? TriangleSubdivision::smooth : TriangleSubdivision::catmull_clark;
        for (int i = below(2) * below(6); i > 0; --i) {
            const std::vector<int>& f = faces[static_cast<std::size_t>(below(count))];
            const auto e = static_cast<std::size_t>(below(static_cast<int>(f.size())));
            mesh.creases.push_back({f[e], f[(e + 1) % f.size()], sharpness()});
        }
        for (int i = below(2) * below(3); i > 0; --i) {
            mesh.corners.push_back({below(points), sharpness()});
        }
        if (below(5) == 0) {
            mesh.holes.push_back(below(count));
        }
        return mesh;
    }
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

private:
    float sharpness() { return below(3) == 0 ? infinite_sharpness : static_cast<float>(below(100)) / 10.0F; }

    /// Grown from an edge of an earlier face two times in three.
    std::vector<int> face(int points, const std::vector<std::vector<int>>& earlier) {
        const auto size = static_cast<std::size_t>(std::min(3 + below(4), points));
        std::vector<int> result;
        if (!earlier.empty() && below(3) != 0) {
            const auto& other = earlier[static_cast<std::size_t>(below(static_cast<int>(earlier.size())))];
            const auto e = static_cast<std::size_t>(below(static_cast<int>(other.size())));
            result = {other[(e + 1) % other.size()], other[e]};
            if (below(8) == 0) {
                std::swap(result[0], result[1]);
            }
        }
        while (result.size() < size) {
            const int p = below(points);
            if (std::find(result.begin(), result.end(), p) == result.end()) {
                result.push_back(p);
            }
        }
        return result;
    }

    std::mt19937 random_;
};

bool is_manifold(const Mesh& mesh) {
    const Adjacency a = build_adjacency(mesh);
    for (int c = 0; c < static_cast<int>(mesh.face_vertices.size()); ++c) {
        std::size_t fan = 1;
        int x = a.counter_clockwise(c);
        for (; x >= 0 && x != c; x = a.counter_clockwise(x)) {
            ++fan;
        }
        if (x < 0) {
            for (x = a.clockwise(c); x >= 0; x = a.clockwise(x)) {
                ++fan;
            }
        }
        if (fan != a.corners_at_point(a.point(c)).size() || a.corners_at_edge(a.leading_edge(c)).size() > 2) {
            return false;
        }
    }
    return true;
}

void check_patch(const Mesh& mesh, const Topology& t, PagePool& pool, const PatchRecord& patch,
                 bool manifold) {
    const FaceRecord& face = t.faces[static_cast<std::size_t>(patch.face)];
    glm::dvec3 low(1e300), high(-1e300);
    for (int c = 0; c < face.control_count; ++c) {
        const int p = t.controls[static_cast<std::size_t>(face.control_first + c)];
        low = glm::min(low, mesh.points[static_cast<std::size_t>(p)]);
        high = glm::max(high, mesh.points[static_cast<std::size_t>(p)]);
    }
    const Samples block = pool.block(patch, 2);
    const glm::dvec3 margin = (high - low) / 256.0;
    for (std::size_t i = 0; i < block.position.size(); ++i) {
        const glm::dvec3 x = block.position[i];
        const double all = x.x + x.y + x.z + glm::dot(block.du[i], block.dv[i]);
        ASSERT_TRUE(std::isfinite(all));
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(x, low - margin)) &&
                    glm::all(glm::lessThanEqual(x, high + margin)));
    }
    for (int side = 0; manifold && side < 4; ++side) {
        const std::vector<glm::dvec3> curve = pool.curve(patch.side_curve[side], 3);
        for (int i = 0; i <= 4; ++i) {
            const double at = curve_parameter(patch.side_flags[side], i / 4.0);
            const std::array<int, 4> index{i, i * 5 + 4, 20 + i, i * 5};
            const glm::dvec3 own =
                block.position[static_cast<std::size_t>(index[static_cast<std::size_t>(side)])];
            ASSERT_LT(glm::length(curve[static_cast<std::size_t>(at * 8)] - own), 1e-6);
        }
    }
}

TEST(RandomCages, AreRenderedOrRefused) {
    int rendered = 0, refused = 0, manifold = 0;
    for (unsigned seed = 0; seed < 1500; ++seed) {
        SCOPED_TRACE(seed);
        CageMaker maker(seed);
        const Mesh mesh = maker.make();
        try {
            validate_mesh(mesh);
            const Topology t = analyse_topology(mesh);
            PagePool pool(mesh, t, 3 + maker.below(8));
            const bool is_one = is_manifold(mesh);
            ++rendered;
            manifold += is_one ? 1 : 0;
            for (const PatchRecord& patch : t.patches) {
                check_patch(mesh, t, pool, patch, is_one);
            }
        } catch (const UserError&) {
            ++refused;
        }
    }
    fmt::print("  {} rendered ({} manifold), {} refused\n", rendered, manifold, refused);
    EXPECT_GT(manifold, 100);
    EXPECT_LT(refused, rendered / 10);
}

} // namespace
} // namespace razor::test
