// What an opacity map cuts out is not there: pictures of a board half of which is cut out are those of half a
// board, in itself, in its shadow, in mirrors and behind glass.
#include "tests/kernels/targets.h"
#include "tests/materials/floor.h"

#include "razor/scene/textures/shared_exponent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace razor::test {
namespace {

using glm::dvec3;

/// Opaque where u < 1/2, by texels alone; each level of it.
Texture half_opaque() {
    auto pyramid = std::make_shared<TexturePyramid>();
    for (int side = 64; side >= 1; side /= 2) {
        TextureLevel level{side, side, {}, {}};
        const int tiles = (side + 3) / 4;
        level.texels.assign(static_cast<std::size_t>(16 * tiles * tiles),
                            pack_shared_exponent({0.9F, 0.6F, 0.3F}));
        level.opacity.assign(level.texels.size(), pack_shared_exponent(glm::vec3(0)));
        for (int y = 0; y < 4 * tiles; ++y)
            for (int x = 0; x < 4 * tiles; ++x) {
                const float there = side == 1 ? 0.5F : 2 * std::min(x, side - 1) < side ? 1.0F : 0.0F;
                level.opacity[static_cast<std::size_t>(16 * (y / 4 * tiles + x / 4) + 4 * (y % 4) + x % 4)] =
                    pack_shared_exponent(glm::vec3(there));
            }
        pyramid->levels.push_back(level);
    }
    Texture t;
    t.name = "half";
    t.wrap_u = t.wrap_v = Wrap::clamp;
    t.pyramid = pyramid;
    return t;
}

/// Upright, from x = -1 to x = right, with u from 0 at x = -1 to 1 at x = 1.
Mesh board(double right, double z, Scheme scheme) {
    Mesh m;
    m.name = "board";
    m.scheme = scheme;
    m.points = {{-1, 0.1, z}, {right, 0.1, z}, {right, 1.6, z}, {-1, 1.6, z}};
    m.face_sizes = {4};
    m.face_vertices = {0, 1, 2, 3};
    const auto u = static_cast<float>((right + 1) / 2);
    m.texcoords = {{0, 0}, {u, 0}, {u, 1}, {0, 1}};
    m.face_texcoords = {0, 1, 2, 3};
    m.boundary = BoundaryInterpolation::edge_and_corner;
    m.edge_length = 0.25;
    m.material = 1;
    return m;
}

/// Two boards behind each other before a mirror, over a floor, under a lamp.
Scene boards(double right, bool glossy, Scheme scheme) {
    Material floor;
    floor.name = "floor";
    floor.albedo = {0.5F, 0.55F, 0.6F};
    Scene s = seen_floor(floor, 0);
    Material paper;
    paper.name = "paper";
    paper.albedo = {1, 1, 1};
    paper.albedo_map.texture = 0;
    paper.alpha_cutoff = 0.5F;
    if (glossy) {
        paper.specular = 1;
        paper.roughness = 0.6F;
    }
    Material mirror;
    mirror.name = "mirror";
    mirror.metallic = glossy ? 1.0F : 0.0F;
    mirror.roughness = 0;
    mirror.albedo = glm::vec3(0.8F);
    s.materials = {floor, paper, mirror};
    s.textures = {half_opaque()};
    Mesh back = board(3, -2, Scheme::bilinear);
    back.name = "back";
    back.points[0].x = back.points[3].x = -3;
    back.texcoords.clear();
    back.face_texcoords.clear();
    back.material = 2;
    s.meshes = {s.meshes[0], board(right, 0, scheme), board(right, -0.8, scheme), back};
    Light lamp;
    lamp.kind = LightKind::point;
    lamp.position = {0.4, 2.2, 1.4};
    lamp.radiance = glm::vec3(8);
    s.lights = {lamp};
    s.sky = glm::vec3(0.2F);
    s.camera.position = {0.6, 1.3, 4};
    s.camera.target = {0, 0.6, 0};
    s.camera.fov_degrees = 35;
    s.settings.width = s.settings.height = 48;
    s.settings.samples = 1;
    s.settings.sky_samples = 64;
    s.settings.bounces = 3;
    s.settings.edge_pixels = 0.25;
    s.settings.lod = Lod::recursive;
    return s;
}

Film shown(const Scene& scene, const std::string& target) {
    RenderOptions options;
    options.threads = 2;
    options.isa = target;
    return render_native(scene, options).film;
}

TEST(Cutouts, AreNotThere) {
    for (const bool glossy : {false, true})
        for (const Scheme scheme : {Scheme::bilinear, Scheme::catmull_clark}) {
            const Scene cut = boards(1, glossy, scheme), half = boards(0, glossy, scheme);
            for (const KernelTable* target : best_target()) {
                const Film a = shown(cut, target->name), b = shown(half, target->name);
                for (const char* name : {"R", "G", "B", "depth.Z"}) {
                    const std::vector<float>& x = a.find(name)->values;
                    const std::vector<float>& y = b.find(name)->values;
                    std::size_t others = 0;
                    for (std::size_t i = 0; i < x.size(); ++i)
                        others += std::abs(x[i] - y[i]) <= 0.03F * std::abs(y[i]) || x[i] == y[i] ? 0 : 1;
                    EXPECT_LT(others, x.size() / 25) // along edges, and of noise
                        << name << ", " << target->name << (glossy ? ", glossy" : ", matte");
                }
            }
        }
}

// Without a cutoff, or where nothing is transparent, all is there, and nothing looks for holes.
TEST(Cutouts, NeedACutoff) {
    Scene whole = boards(1, false, Scheme::bilinear);
    whole.materials[1].alpha_cutoff = 0;
    Frame frame(whole, {});
    EXPECT_EQ(frame.header().cutouts, 0);
    Frame with(boards(1, false, Scheme::bilinear), {});
    EXPECT_EQ(with.header().cutouts, 1);
    const std::string target = native_targets().back()->name;
    const Film cut = shown(boards(1, false, Scheme::bilinear), target), all = shown(whole, target);
    std::size_t others = 0;
    for (std::size_t i = 0; i < cut.pixel_count(); ++i)
        others += cut.find("depth.Z")->values[i] > 1.02F * all.find("depth.Z")->values[i] ? 1 : 0;
    EXPECT_GT(others, cut.pixel_count() / 12);
}

// As many as there are, up to a bound; then what is left is there, and the frame ends.
TEST(Cutouts, MayBeMany) {
    Scene scene = boards(1, false, Scheme::bilinear);
    scene.settings.width = scene.settings.height = 16;
    scene.meshes.resize(1);
    for (int n = 0; n < 80; ++n) {
        scene.meshes.push_back(board(1, -0.01 * n, Scheme::bilinear));
        scene.meshes.back().name = "board " + std::to_string(n);
        for (glm::vec2& at : scene.meshes.back().texcoords)
            at.x = 0.9F; // all of it cut out
    }
    const Film film = shown(scene, native_targets().back()->name);
    for (const char* name : {"R", "G", "B"})
        for (const float value : film.find(name)->values)
            EXPECT_TRUE(std::isfinite(value));
}

} // namespace
} // namespace razor::test
