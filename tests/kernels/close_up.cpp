// Coarse cages seen from so near that edges have their largest exponent, 2^13 segments: nobody could make all
// of that, so rays look at a few places, and what they make there is compared.
#include "razor/check/dump.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/oracle.h"
#include "tests/kernels/reference_surface.h"
#include "tests/kernels/targets.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

namespace razor::test {
namespace {

Mesh pentagonal_prism() {
    Mesh m;
    m.name = "prism";
    for (int k = 0; k < 10; ++k) {
        const double a = 2 * 3.14159265358979 * k / 5;
        m.points.emplace_back(std::cos(a), std::sin(a), k < 5 ? -0.4 : 0.5);
    }
    m.face_sizes = {5, 5, 4, 4, 4, 4, 4};
    m.face_vertices = {4, 3, 2, 1, 0, 5, 6, 7, 8, 9};
    for (int k = 0; k < 5; ++k)
        for (const int corner : {k, (k + 1) % 5, (k + 1) % 5 + 5, k + 5})
            m.face_vertices.push_back(corner);
    return m;
}

Mesh cage(const std::string& name) {
    if (name == "cube")
        return cube_cage();
    if (name == "cube_stretched")
        return stretched(cube_cage());
    if (name == "cube_bilinear")
        return bilinear(stretched(cube_cage()));
    if (name == "prism")
        return pentagonal_prism();
    return tapered_cage();
}

glm::dvec3 vec(const Point& p) {
    return {p[0], p[1], p[2]};
}
Point to_point(const glm::dvec3& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

class CloseUp : public testing::TestWithParam<std::string> {
protected:
    struct Place {
        int patch;
        int i, j; // a vertex of its finest grid
    };

    void SetUp() override {
        mesh_ = cage(GetParam());
        scene_ = scene_of(mesh_, 10);
        const Topology t = analyse_topology(mesh_);
        for (const CurveRecord& c : t.curves)
            if ((c.flags & curve_spoke) == 0)
                longest_ = std::max(longest_, glm::length(mesh_.points[static_cast<std::size_t>(c.end1)] -
                                                          mesh_.points[static_cast<std::size_t>(c.end0)]));
        scene_.meshes[0].edge_length = longest_ / 16000;
    }
    /// Before anything else is made of the frame.
    void look_at(Frame& frame) {
        frame_ = &frame;
        surface_ = std::make_unique<ReferenceSurface>(frame, mesh_);
        edge_ = frame.header().instances.get()[0].edge_length;
        origin_ = vec(instance_origins(frame)[0]);
    }
    const PatchRecord& patch(int i) const { return frame_->header().patches.get()[i]; }
    bool is_curved(int i) const { return patch(i).kind < PatchKind::flat_quad; }

    /// In the middle of patches, beside their sides and beside their corners.
    std::vector<Place> places() const {
        std::vector<Place> found;
        const int count = frame_->header().instances.get()[0].patch_count;
        for (const int p : {0, count - 1}) {
            if (!is_curved(p))
                continue;
            const auto [nu, nv] = surface_->grid(patch(p));
            const int across = 1 << nu, up = 1 << nv;
            found.push_back({p, across / 2 + 3, up / 3});
            found.push_back({p, 2, up / 2 + 1});
            found.push_back({p, across - 3, up - 2});
            found.push_back({p, across / 4, up - 1});
        }
        return found;
    }
    const glm::dvec3& origin() const { return origin_; }
    glm::dvec3 at(const Place& p, int di, int dj) const {
        const auto [nu, nv] = surface_->grid(patch(p.patch));
        return origin() + surface_->grid_point(patch(p.patch), std::clamp(p.i + di, 0, 1 << nu),
                                               std::clamp(p.j + dj, 0, 1 << nv));
    }
    /// Away from the mesh's centre.
    glm::dvec3 outward(const Place& p) const {
        const glm::dvec3 n =
            glm::normalize(glm::cross(at(p, 3, 0) - at(p, -3, 0), at(p, 0, 3) - at(p, 0, -3)));
        return glm::dot(n, at(p, 0, 0) - origin()) < 0 ? -n : n;
    }
    /// From `from` to vertices, edges and insides of triangles about a place.
    std::vector<Ray> rays_at(const Place& p, const glm::dvec3& from, int count, unsigned seed) const {
        std::mt19937 random(seed);
        const auto pick = [&] { return static_cast<int>(random() % 17) - 8; };
        std::vector<Ray> rays;
        while (static_cast<int>(rays.size()) < count) {
            const int i = pick(), j = pick();
            const double along = 0.25 * std::abs(pick() % 4);
            const double inside = pick() % 3 == 0 ? 0.3 : 0;
            const glm::dvec3 to =
                glm::mix(glm::mix(at(p, i, j), at(p, i + 1, j + 1), along), at(p, i + 1, j), inside);
            Ray ray;
            ray.origin = to_point(from);
            ray.direction = to_point(glm::normalize(to - vec(ray.origin)));
            rays.push_back(ray);
        }
        return rays;
    }

    Mesh mesh_;
    Scene scene_;
    Frame* frame_ = nullptr;
    std::unique_ptr<ReferenceSurface> surface_;
    double longest_ = 0, edge_ = 0;
    glm::dvec3 origin_{0};
};

std::vector<const KernelTable*> both_roundings() {
    std::vector<const KernelTable*> targets;
    for (const KernelTable* target : native_targets())
        if (target == native_targets().back() || target->name == std::string("sse4"))
            targets.push_back(target); // the others have the same bits
    return targets;
}

TEST_P(CloseUp, HasFourteenLevels) {
    Frame frame(scene_, {});
    look_at(frame);
    EXPECT_EQ(frame.header().instances.get()[0].max_exponent, 13);
    int largest = 0;
    for (int c = 0; c < static_cast<int>(surface_->topology().curves.size()); ++c)
        largest = std::max(largest, surface_->exponent(c));
    EXPECT_EQ(largest, 13);
}

TEST_P(CloseUp, HitsEqualBruteForce) {
    for (const KernelTable* target : both_roundings()) {
        Frame frame(scene_, {});
        Tracer tracer(frame, 2048, 1);
        look_at(frame);
        unsigned seed = 1;
        for (const Place& p : places()) {
            SCOPED_TRACE(testing::Message()
                         << target->name << " patch " << p.patch << " at " << p.i << ' ' << p.j);
            const std::vector<Ray> rays = rays_at(p, at(p, 0, 0) + 30 * edge_ * outward(p), 256, ++seed);
            tracer.closest(*target, rays); // makes what there is
            std::vector<Triangle> near;
            for (const Triangle& t : triangles_of(frame))
                if (glm::length(origin() + vec(t.vertex[0]) - at(p, 0, 0)) < 60 * edge_)
                    near.push_back(t);
            ASSERT_GT(near.size(), 200U);
            const Oracle oracle(near, instance_origins(frame), target->name != std::string("sse4"));
            const std::vector<Hit> hits = tracer.closest(*target, rays);
            const std::vector<int> axes = shear_axes(rays, target->width);
            std::set<int> numbers;
            int compared = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const glm::dvec3 hit = vec(rays[i].origin) + double{hits[i].t} * vec(rays[i].direction);
                if (hits[i].patch >= 0 && glm::length(hit - at(p, 0, 0)) > 45 * edge_)
                    continue; // past the border of what it looks at
                ++compared;
                ASSERT_EQ(hits[i], oracle.closest(rays[i], axes[i])) << "ray " << i;
                numbers.insert(hits[i].triangle);
            }
            EXPECT_GT(compared, 200);
            EXPECT_GT(numbers.size(), 50U); // each a triangle or two of the finest grid
        }
    }
}

TEST_P(CloseUp, NoRayEscapes) {
    for (const KernelTable* target : both_roundings()) {
        Frame frame(scene_, {});
        Tracer tracer(frame, 2048, 1);
        look_at(frame);
        unsigned seed = 100;
        for (const Place& p : places())
            for (const bool near : {true, false})
                for (const double base : {0.0, 0.7, 1.6, 6.0}) {
                    // The cages are seen whole from their centres.
                    const glm::dvec3 in = glm::normalize(origin() - at(p, 0, 0));
                    std::vector<Ray> rays =
                        rays_at(p, near ? at(p, 0, 0) + 30 * edge_ * in : origin(), 256, ++seed);
                    for (Ray& r : rays) {
                        r.base = static_cast<float>(base * edge_);
                        r.growth = base > 0 && near ? 0.1F : 0;
                    }
                    const std::vector<Hit> hits = tracer.closest(*target, rays);
                    const auto escaped =
                        std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.patch < 0; });
                    EXPECT_EQ(escaped, 0)
                        << target->name << " patch " << p.patch << " at " << p.i << ' ' << p.j
                        << (near ? ", near" : ", far") << ", base " << base << " edges";
                }
    }
}

TEST_P(CloseUp, VerticesLieOnTheSurfaceAndNeighboursAgree) {
    for (const KernelTable* target : both_roundings()) {
        Frame frame(scene_, {});
        Tracer tracer(frame, 2048, 1);
        look_at(frame);
        for (const Place& p : places())
            tracer.closest(*target, rays_at(p, at(p, 0, 0) + 30 * edge_ * outward(p), 64, 7));
        std::map<std::pair<int, int>, Point> shared; // by curve and point on it
        int inner = 0, agreed = 0, finest = 0;
        for (int n = 0; n < frame.header().instances.get()[0].patch_count; ++n) {
            const PatchRecord& record = patch(n);
            if (!is_curved(n) || frame.header().trees.get()[0].patches.get()[n].state.word != ready)
                continue;
            const auto [nu, nv] = surface_->grid(record);
            for (int level = 0; level <= std::min({nu, nv, 4}); level += 2)
                for (const BlockView& b : blocks_of(frame, n, 0, level))
                    for (int v = 0; v < b.header->stride; ++v) {
                        const int i = (b.header->column * block_quads + v % (b.header->quads_u + 1)) << level;
                        const int j = (b.header->row * block_quads + v / (b.header->quads_u + 1)) << level;
                        const int side = j == 0 ? 0 : i == 1 << nu ? 1 : j == 1 << nv ? 2 : i == 0 ? 3 : -1;
                        if (side < 0) {
                            ++inner;
                            finest += level == 0 && std::max(nu, nv) >= 12 ? 1 : 0;
                            const glm::dvec3 off =
                                glm::abs(vec(b.vertex(v)) - surface_->grid_point(record, i, j));
                            ASSERT_LE(std::max({off.x, off.y, off.z}), surface_->rounding());
                            continue;
                        }
                        if (level > 0)
                            continue;
                        const int flags = record.side_flags[side], curve = record.side_curve[side];
                        const int grid = (side % 2 == 0 ? nu : nv) + ((flags & side_half) != 0 ? 1 : 0);
                        const int down = grid - surface_->exponent(curve);
                        int along = side % 2 == 0 ? i : j;
                        along = (flags & side_reversed) != 0 ? (1 << grid) - along : along;
                        if (along % (1 << down) != 0)
                            continue; // hangs
                        const auto [known, fresh] = shared.try_emplace({curve, along >> down}, b.vertex(v));
                        if (!fresh) {
                            ++agreed;
                            for (std::size_t k = 0; k < 3; ++k)
                                ASSERT_EQ(std::bit_cast<std::uint32_t>(known->second[k]),
                                          std::bit_cast<std::uint32_t>(b.vertex(v)[k]))
                                    << "curve " << curve << " point " << (along >> down);
                        }
                    }
        }
        EXPECT_GT(inner, 10000);
        EXPECT_GT(finest, 2000);
        EXPECT_GT(agreed, 20);
    }
}

INSTANTIATE_TEST_SUITE_P(Cages, CloseUp,
                         testing::Values("cube", "cube_stretched", "cube_bilinear", "prism", "tapered"),
                         [](const auto& name) { return name.param; });

} // namespace
} // namespace razor::test
