// Where vertices of displaced surfaces lie, and their normals, against OpenSubdiv's own evaluator and a
// lookup of heights in double. Shared points lie where the face that owns them has them, with its normal, its
// texture coordinates and its filter.
#include "razor/check/dump.h"
#include "razor/surface/refiner.h"
#include "tests/displacement/heights.h"
#include "tests/kernels/cages.h"
#include "tests/kernels/targets.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <algorithm>
#include <cmath>

namespace razor::test {
namespace {

namespace Bfr = OpenSubdiv::Bfr;
using glm::dvec2;
using glm::dvec3;

/// A point of the surface before it is displaced, by a patch's own (u, v).
struct Place {
    dvec3 p{0}, du{0}, dv{0};
    dvec2 uv{0};
};

/// Faces by OpenSubdiv, or bilinear ones by hand.
class Surface {
public:
    explicit Surface(const Mesh& mesh) : mesh_(mesh) {
        int first = 0;
        for (const int size : mesh.face_sizes) {
            first_.push_back(first);
            first += size;
        }
        if (mesh.scheme == Scheme::catmull_clark) {
            refiner_ = make_refiner(mesh);
            factory_ =
                std::make_unique<Bfr::RefinerSurfaceFactory<>>(*refiner_, Bfr::SurfaceFactory::Options()
                                                                              .EnableCaching(false)
                                                                              .SetApproxLevelSmooth(10)
                                                                              .SetApproxLevelSharp(10));
        }
    }

    Place at(int face, int sub, dvec2 at) const {
        const int size = mesh_.face_sizes[static_cast<std::size_t>(face)];
        const std::vector<dvec3> corners = of_corners(face, [&](std::size_t c) {
            return mesh_.points[static_cast<std::size_t>(mesh_.face_vertices[c])];
        });
        const std::vector<dvec3> coordinates = of_corners(face, [&](std::size_t c) {
            return dvec3(mesh_.texcoords[static_cast<std::size_t>(mesh_.face_texcoords[c])], 0);
        });
        Place place = straight(corners, sub, at);
        place.uv = dvec2(straight(coordinates, sub, at).p);
        if (mesh_.scheme == Scheme::bilinear)
            return place;
        if (face != known_) { // building one takes longest
            if (!factory_->InitVertexSurface(face, &surface_))
                throw std::logic_error("no surface");
            known_ = face;
        }
        const Bfr::Surface<double>& surface = surface_;
        std::vector<int> points(static_cast<std::size_t>(surface.GetNumControlPoints()));
        surface.GetControlPointIndices(points.data());
        std::vector<double> w(points.size()), wu(points.size()), wv(points.size());
        double uv[2] = {at.x, at.y};
        if (size != 4) {
            const double own[2] = {at.x, at.y};
            Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_CATMARK, size)
                .ConvertNormalizedSubFaceToCoord(sub, own, uv);
        }
        surface.EvaluateStencil(uv, w.data(), wu.data(), wv.data());
        const bool smooth = mesh_.face_varying == FaceVaryingInterpolation::none;
        Place result;
        result.uv = smooth ? dvec2(0) : place.uv;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto point = static_cast<std::size_t>(points[k]);
            result.p += w[k] * mesh_.points[point];
            result.du += wu[k] * mesh_.points[point];
            result.dv += wv[k] * mesh_.points[point];
            if (smooth) // closed, without tags: coordinates are smoothed as points are
                result.uv += w[k] * dvec2(mesh_.texcoords[point]);
        }
        return result;
    }

    bool is_smooth() const { return mesh_.scheme == Scheme::catmull_clark; }
    bool is_part(int face) const { return mesh_.face_sizes[static_cast<std::size_t>(face)] != 4; }

    /// Of texture coordinates per area.
    double density(int face) const {
        const auto first = static_cast<std::size_t>(first_[static_cast<std::size_t>(face)]);
        const auto n = static_cast<std::size_t>(mesh_.face_sizes[static_cast<std::size_t>(face)]);
        dvec3 area(0);
        double of_texture = 0;
        for (std::size_t k = 0; k < n; ++k) { // Newell's sums
            const std::size_t a = first + k, b = first + (k + 1) % n;
            area += glm::cross(mesh_.points[static_cast<std::size_t>(mesh_.face_vertices[a])],
                               mesh_.points[static_cast<std::size_t>(mesh_.face_vertices[b])]);
            const dvec2 s = mesh_.texcoords[static_cast<std::size_t>(mesh_.face_texcoords[a])],
                        t = mesh_.texcoords[static_cast<std::size_t>(mesh_.face_texcoords[b])];
            of_texture += s.x * t.y - s.y * t.x;
        }
        return std::abs(of_texture) / glm::length(area);
    }

private:
    template <class Get> std::vector<dvec3> of_corners(int face, Get get) const {
        std::vector<dvec3> values;
        const int first = first_[static_cast<std::size_t>(face)];
        for (int k = 0; k < mesh_.face_sizes[static_cast<std::size_t>(face)]; ++k)
            values.push_back(get(static_cast<std::size_t>(first + k)));
        return values;
    }
    static Place straight(const std::vector<dvec3>& c, int sub, dvec2 at) {
        const std::size_t n = c.size(), s = static_cast<std::size_t>(sub);
        dvec3 q[4] = {c[0], c[1], c[2], c[n == 3 ? 2 : 3]};
        if (n != 4) {
            dvec3 mean(0);
            for (const dvec3& p : c)
                mean += p / static_cast<double>(n);
            q[0] = c[s];
            q[1] = 0.5 * (c[s] + c[(s + 1) % n]);
            q[2] = mean;
            q[3] = 0.5 * (c[s] + c[(s + n - 1) % n]);
        }
        Place p;
        p.p = (1 - at.y) * ((1 - at.x) * q[0] + at.x * q[1]) + at.y * ((1 - at.x) * q[3] + at.x * q[2]);
        p.du = (1 - at.y) * (q[1] - q[0]) + at.y * (q[2] - q[3]);
        p.dv = (1 - at.x) * (q[3] - q[0]) + at.x * (q[2] - q[1]);
        return p;
    }

    const Mesh& mesh_;
    mutable Bfr::Surface<double> surface_;
    mutable int known_ = -1;
    std::vector<int> first_;
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner_;
    std::unique_ptr<Bfr::RefinerSurfaceFactory<>> factory_;
};

/// A scene's one mesh, displaced.
class Displaced {
public:
    explicit Displaced(const Scene& scene) : surface(scene.meshes[0]), scene_(scene) {}

    dvec3 at(int face, int sub, const dvec2& at, double edge) const {
        const Place p = surface.at(face, sub, at);
        return p.p + height(face, p.uv, edge) * normal(p);
    }

    /// By how the surface's normal turns over very little, and by what heights differ by over these steps.
    dvec3 normal_at(int face, int sub, const dvec2& at, double edge, const dvec2& steps) const {
        const Place p = surface.at(face, sub, at);
        const double h = height(face, p.uv, edge);
        const auto along = [&](const dvec2& way, double step, const dvec3& slope) {
            const auto near = [&](double x) { return surface.at(face, sub, at + x * way); };
            constexpr double little = 1e-5;
            const dvec3 turn = (normal(near(little)) - normal(near(-little))) / (2 * little);
            const dvec2 uv = (near(little).uv - near(-little).uv) / (2 * little);
            const double rise =
                (height(face, p.uv + 0.5 * step * uv, edge) - height(face, p.uv - 0.5 * step * uv, edge)) /
                step;
            return slope + rise * normal(p) + h * turn;
        };
        // Of OpenSubdiv's own parameters: twice those of a sub-face.
        const double twice = surface.is_part(face) && surface.is_smooth() ? 2 : 1;
        const dvec3 u = along({1, 0}, steps.x, twice == 2 ? 0.5 * p.du : p.du);
        const dvec3 v = along({0, 1}, steps.y, twice == 2 ? 0.5 * p.dv : p.dv);
        return glm::normalize(glm::cross(u, v));
    }

    Surface surface;

private:
    static dvec3 normal(const Place& p) { return glm::normalize(glm::cross(p.du, p.dv)); }
    double height(int face, const dvec2& coordinates, double edge) const {
        const Material& m = scene_.materials[0];
        const Texture& texture = scene_.textures[0];
        const double c = std::cos(double{m.displacement_map.rotation}),
                     s = std::sin(double{m.displacement_map.rotation});
        const dvec2 scale(m.displacement_map.scale), q = coordinates * scale;
        const dvec2 uv = dvec2(m.displacement_map.offset) + dvec2(c * q.x - s * q.y, s * q.x + c * q.y);
        if (texture.pattern)
            return double{m.displacement_scale} * (lookup(texture, uv, 0) - double{m.displacement_midlevel});
        const double texels = surface.density(face) * edge * edge * std::abs(scale.x * scale.y) *
                              texture.heights->levels[0].width * texture.heights->levels[0].height;
        const double level = 0.5 * std::log2(std::max(texels, 1e-12));
        return double{m.displacement_scale} * (lookup(texture, uv, level) - double{m.displacement_midlevel});
    }

    const Scene& scene_;
};

/// A point of a face: of which sub-face, and where.
struct FacePoint {
    int face = 0, sub = 0;
    dvec2 at{0};
};

/// The point at parameter t of a face's local curve (CurveRecord::owner_local), as the face runs.
FacePoint on_curve(int face, int corners, int local, double t) {
    if (local >= corners)
        return {face, local - corners, {1, t}};
    if (corners != 4)
        return t <= 0.5 ? FacePoint{face, local, {2 * t, 0}}
                        : FacePoint{face, (local + 1) % corners, {0, 2 - 2 * t}};
    const dvec2 along[] = {{t, 0}, {1, t}, {1 - t, 1}, {0, 1 - t}};
    return {face, 0, along[local]};
}

/// Who has a point that lies on side s of a patch, at parameter x.
FacePoint owner_of(Frame& frame, const PatchRecord& patch, int s, double x) {
    const FrameHeader& h = frame.header();
    const auto corners = [&](int face) { return h.faces.get()[face].corner_count; };
    const bool part = (patch.side_flags[0] & side_half) != 0;
    if (x == 0 || x == 1) {
        constexpr int ends[4][2] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}};
        const int k = ends[s][x == 0 ? 0 : 1];
        if (part && k == 2)
            return {patch.face, 0, {1, 1}};
        if (!part || k == 0) {
            const VertexRecord& v = h.vertices.get()[patch.corner[k]];
            return corners(v.owner_face) == 4 ? on_curve(v.owner_face, 4, v.owner_corner, 0)
                                              : FacePoint{v.owner_face, v.owner_corner, {0, 0}};
        }
        s = k == 1 ? 0 : 3; // middles of edges are points of these
        x = 1;
    }
    const CurveRecord& curve = h.curves.get()[patch.side_curve[s]];
    double t = (patch.side_flags[s] & side_half) != 0 ? x / 2 : x;
    t = (patch.side_flags[s] & side_reversed) != 0 ? 1 - t : t;
    t = (curve.flags & curve_owner_reversed) != 0 ? 1 - t : t;
    return on_curve(curve.owner_face, corners(curve.owner_face), curve.owner_local, t);
}

struct Worst {
    double position = 0, cosine = 1; // of normals
    double shared = 0;               // of shared points
    int vertices = 0, sides = 0;
    double moved = 0; // from the surface
};

/// At level 0.
Worst compare(const Scene& scene) {
    Frame frame(scene, {});
    frame.build_all(*native_targets().back());
    frame.dice_all(*native_targets().back());
    const Displaced expected(scene);
    const InstanceRecord& instance = frame.header().instances.get()[0];
    const dvec3 origin = frame.origin() + dvec3(instance.origin[0], instance.origin[1], instance.origin[2]);
    Worst worst;
    for (int patch = 0; patch < instance.patch_count; ++patch) {
        const PatchRecord& record = check::patch_record(frame, patch);
        for (const check::BlockView& b : check::blocks_of(frame, patch)) {
            const BlockHeader& h = *b.header;
            const double across = std::ldexp(1.0, h.exponent[0]), up = std::ldexp(1.0, h.exponent[1]);
            for (int j = 0; j <= h.quads_v; ++j)
                for (int i = 0; i <= h.quads_u; ++i) {
                    const dvec2 at((h.column * block_quads + i) / across, (h.row * block_quads + j) / up);
                    const int v = j * (h.quads_u + 1) + i;
                    const check::Point p = b.vertex(v);
                    const dvec3 is = origin + dvec3(p[0], p[1], p[2]);
                    const double edge = double{instance.mesh_edge_length};
                    const int s = at.y == 0 ? 0 : at.x == 1 ? 1 : at.y == 1 ? 2 : at.x == 0 ? 3 : -1;
                    if (s >= 0) {
                        if (h.hang[s] != 0) // between the curve's
                            continue;
                        const FacePoint q = owner_of(frame, record, s, s % 2 == 0 ? at.x : at.y);
                        worst.shared =
                            std::max(worst.shared, glm::length(is - expected.at(q.face, q.sub, q.at, edge)));
                        ++worst.sides;
                        continue;
                    }
                    const dvec3 there = expected.at(record.face, record.sub, at, edge);
                    worst.position = std::max(worst.position, glm::length(is - there));
                    worst.moved = std::max(
                        worst.moved, glm::length(is - expected.surface.at(record.face, record.sub, at).p));
                    ++worst.vertices;
                    if (h.normals.word != ready || worst.vertices % 5 != 0)
                        continue;
                    const float* n = b.words + h.normals_at + v;
                    const dvec3 normal(n[0], n[h.stride], n[2 * h.stride]);
                    const dvec3 other =
                        expected.normal_at(record.face, record.sub, at, edge, dvec2(1 / across, 1 / up));
                    worst.cosine = std::min(worst.cosine, glm::dot(normal, other));
                }
        }
    }
    return worst;
}

Mesh fivefold_prism() {
    Mesh m;
    m.name = "prism";
    const int n = 5;
    for (int k = 0; k < 2 * n; ++k) {
        const double angle = 6.283185307179586 * (k % n) / n;
        m.points.emplace_back(std::cos(angle), k < n ? -0.7 : 0.8, -std::sin(angle));
    }
    m.face_sizes = {n, n};
    for (int k = 0; k < n; ++k)
        m.face_vertices.push_back(n - 1 - k);
    for (int k = 0; k < n; ++k)
        m.face_vertices.push_back(n + k);
    for (int k = 0; k < n; ++k) {
        m.face_sizes.push_back(4);
        const int a = k, b = (k + 1) % n;
        m.face_vertices.insert(m.face_vertices.end(), {a, b, n + b, n + a});
    }
    return m;
}

void expect_right(const Mesh& mesh, const Texture& texture, double scale, const TextureMap& map,
                  const std::string& what) {
    Scene scene = displaced_scene(mesh, 60, texture, scale, 0.4);
    scene.materials[0].displacement_map = map;
    scene.settings.lod = Lod::object;
    const Worst w = compare(scene);
    EXPECT_GT(w.vertices, 1000) << what;
    EXPECT_GT(w.moved, 0.4 * std::abs(scale)) << what;
    EXPECT_LT(w.position, 4e-6) << what;
    EXPECT_GT(w.sides, 200) << what;
    EXPECT_LT(w.shared, 4e-6) << what;
    EXPECT_GT(w.cosine, 0.99999) << what;
}

TEST(DisplacedPositions, AreThoseOfTheSurfaceAlongItsNormals) {
    const TextureMap plain{.texture = 0};
    TextureMap turned{.texture = 0, .scale = {1.5F, -0.8F}, .offset = {0.3F, 0.1F}, .rotation = 0.7F};
    Mesh creased = cube_cage();
    creased.creases = {{0, 1, 3}, {2, 3, 10}};
    for (const Mesh& mesh : {cube_cage(), fivefold_prism(), torus_cage(7, 5), urchin_cage()}) {
        expect_right(with_smooth_texcoords(mesh), smooth_heights(), 0.1, plain, mesh.name + ", smooth");
        expect_right(with_seams(mesh), smooth_heights(), -0.15, turned, mesh.name + ", seams");
        expect_right(with_seams(bilinear(mesh)), smooth_heights(), 0.1, turned, mesh.name + ", bilinear");
    }
    expect_right(with_seams(creased), smooth_heights(), 0.1, plain, "creased");
}

TEST(DisplacedPositions, ByPatternsAsWell) {
    TextureMap turned{.texture = 0, .scale = {1.5F, -0.8F}, .offset = {0.3F, 0.1F}, .rotation = 0.7F};
    for (const PatternKind kind : {PatternKind::noise, PatternKind::marble, PatternKind::wood})
        expect_right(with_seams(cube_cage()), pattern_heights(kind), 0.15, turned,
                     fmt::format("pattern {}", static_cast<int>(kind)));
}

TEST(DisplacedPositions, FollowWrapsAndLevels) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const float scale : {0.2F, 2.0F, 30.0F}) {
            Texture texture = random_heights();
            texture.wrap_u = wrap;
            texture.wrap_v = wrap;
            Scene scene = displaced_scene(with_seams(cube_cage()), 40, texture, 0.1, 0.5);
            scene.materials[0].displacement_map.scale = {scale, scale};
            scene.settings.lod = Lod::object;
            EXPECT_LT(compare(scene).position, 4e-6 * std::max(1.0F, scale)) << scale;
        }
}

} // namespace
} // namespace razor::test
