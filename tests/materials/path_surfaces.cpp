// Pictures of rough glass, of what is metal in part, of textures that colour, bend, shine and cut out, of
// subdivided cages and of instances against paths that are followed one by one in double.
#include "tests/kernels/cages.h"
#include "tests/materials/compare_paths.h"
#include "tests/materials/room.h"

#include "razor/scene/textures/pyramid_builder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

namespace razor::test {
namespace {

Texture checks(PatternSpace space, double size) {
    Texture t;
    t.name = "checks";
    t.pattern = Pattern{.kind = PatternKind::checker, .space = space, .size = size};
    t.pattern->low = {0.1F, 0.2F, 0.6F};
    t.pattern->high = {0.9F, 0.7F, 0.3F};
    return t;
}

/// With a back wall and a floor of checks.
Scene chequered_room() {
    Scene s = room();
    s.textures = {checks(PatternSpace::object, 0.7)};
    s.materials[0].albedo_map.texture = s.materials[1].albedo_map.texture = 0;
    s.materials[0].albedo = s.materials[1].albedo = {1, 1, 1};
    s.settings.edge_pixels = 0.1;
    s.settings.diffuse_bounces = 1;
    return s;
}

TEST(PathsOfSurfaces, RoughGlass) {
    for (const float roughness : {0.5F, 0.8F}) {
        Scene s = chequered_room();
        s.name = fmt::format("glass of roughness {}", roughness);
        s.meshes.push_back(box("glass", {-1.3, 0.1, -0.2}, {1.8, 1.9, 0.6}, 20, 3));
        s.materials.push_back(named("glass", {0.9F, 1, 0.9F}));
        Material& m = s.materials.back();
        m.specular = m.transmission = 1;
        m.roughness = roughness;
        m.ior = 1.4F;
        s.settings.bounces = 5;
        const PlainPicture want = expect_same_picture(s, 1280);
        Scene smooth = s, denser = s;
        smooth.materials[3].roughness = 0;

        denser.materials[3].ior = 3;
        expect_other_picture(want, smooth);
        expect_other_picture(want, denser);
    }
}

/// Weights of metal, transmission, specular reflection, coat and sheen that are neither 0 nor 1, together.
TEST(PathsOfSurfaces, OfEverythingAPart) {
    for (const float roughness : {0.0F, 0.4F}) {
        Scene s = chequered_room();
        s.name = fmt::format("of everything a part, roughness {}", roughness);
        s.meshes.push_back(box("box", {-1.3, 0.1, -0.2}, {1.8, 1.9, 0.6}, 20, 3));
        s.materials.push_back(named("mixed", {0.9F, 0.7F, 0.4F}));
        Material& m = s.materials.back();
        m.metallic = 0.4F;
        m.specular = 0.7F;
        m.transmission = 0.6F;
        m.roughness = roughness;
        m.coat = 0.9F;
        m.coat_roughness = 0.25F;
        m.sheen = {0.6F, 0.3F, 0.8F};
        m.sheen_roughness = 0.5F;
        const PlainPicture want = expect_same_picture(s, 640);
        for (const auto& change : std::vector<std::function<void(Material&)>>{
                 [](Material& o) { o.metallic = 0; }, [](Material& o) { o.transmission = 0; }}) {
            Scene other = s;
            change(other.materials[3]);
            expect_other_picture(want, other);
        }
    }
}

/// colour and opacity of (u, v), v from the top.
Texture picture(int width, int height, const std::function<glm::vec4(double, double)>& texel) {
    PyramidBuilder builder(width, height);
    for (int y = 0; y < height; ++y) {
        std::vector<glm::vec4> row;
        for (int x = 0; x < width; ++x)
            row.push_back(texel((x + 0.5) / width, (y + 0.5) / height));
        builder.add_row(row);
    }
    Texture t;
    t.name = "picture";
    t.linear = true;
    t.pyramid = std::make_shared<const TexturePyramid>(builder.finish());
    return t;
}

void lay_out(Mesh& quad, float wide, float high) {
    quad.texcoords = {{0, 0}, {wide, 0}, {wide, high}, {0, high}};
    quad.face_texcoords = {0, 1, 2, 3};
}

/// Few large texels, so that no ray's filter reaches beyond what lies between two of them.
Scene textured_room() {
    Scene s = room();
    s.textures = {picture(8, 6, [](double u, double v) {
        const bool odd = (static_cast<int>(8 * u) + static_cast<int>(6 * v)) % 2 == 1;
        return glm::vec4(odd ? 0.9 : 0.2, u, v, 1);
    })};
    lay_out(s.meshes[0], 1.5F, 1.25F);
    lay_out(s.meshes[1], 2, 1);
    s.materials[0].albedo = {1, 0.9F, 0.8F};
    s.settings.diffuse_bounces = 1;
    s.settings.edge_pixels = 0.1;
    return s;
}

TEST(PathsOfTextures, ColourPlacedAndWrapped) {
    for (const Wrap wrap_u : {Wrap::repeat, Wrap::clamp, Wrap::mirror}) {
        Scene s = textured_room();
        s.name = fmt::format("picture, wrapped by {}", static_cast<int>(wrap_u));
        s.textures[0].wrap_u = wrap_u;
        s.textures[0].wrap_v = wrap_u == Wrap::clamp ? Wrap::mirror : Wrap::clamp;
        s.materials[0].albedo_map = {
            .texture = 0, .scale = {1.2F, 1.4F}, .offset = {0.2F, -0.3F}, .rotation = 0.4F};
        const PlainPicture want = expect_same_picture(s, 160);
        Scene turned = s, exchanged = s, none = s;
        turned.materials[0].albedo_map.rotation = 0;
        std::swap(exchanged.textures[0].wrap_u, exchanged.textures[0].wrap_v);
        none.materials[0].albedo_map.texture = -1;
        for (const Scene& other : {turned, exchanged, none})
            expect_other_picture(want, other);
    }
}

TEST(PathsOfTextures, MetalRoughnessAndEmission) {
    Scene s = textured_room();
    s.name = "pictures of metal, roughness and emission";
    s.materials[0].metallic = 1;
    s.materials[0].roughness = 0.9F;
    s.materials[0].metallic_map.texture = s.materials[0].roughness_map.texture = 0;
    s.materials[1].emission = {0.9F, 0.6F, 1};
    s.materials[1].emission_map.texture = 0;
    const PlainPicture want = expect_same_picture(s, 320);
    for (TextureMap Material::*const map :
         {&Material::metallic_map, &Material::roughness_map, &Material::emission_map}) {
        Scene other = s;
        for (Material& m : other.materials)
            (m.*map).texture = -1;
        expect_other_picture(want, other);
    }
}

TEST(PathsOfTextures, NormalsAndBumps) {
    for (const bool plastic : {false, true}) {
        Scene s = textured_room();
        s.name = plastic ? "normal map and bumps of plastic" : "normal map and bumps";
        s.textures[0] = picture(8, 6, [](double u, double v) {
            const double x = 0.6 * std::sin(6.283 * u), y = 0.5 * std::cos(6.283 * v);
            return glm::vec4(0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * std::sqrt(1 - x * x - y * y), 1);
        });
        lay_out(s.meshes[0], 1, 1);
        s.textures.push_back(picture(5, 5, [](double u, double v) {
            return glm::vec4(glm::vec3(static_cast<float>(std::fmod(3 * u + 2 * v, 1))), 1);
        }));
        s.materials[0].normal_map.texture = 0;
        s.materials[0].normal_scale = 0.8F;
        s.materials[1].bump_map.texture = 1;
        s.materials[1].bump = 0.6F;
        for (const std::size_t m : {0U, 1U}) {
            s.materials[m].specular = plastic ? 1.0F : 0.0F;
            s.materials[m].roughness = 0.5F;
        }
        const PlainPicture want = expect_same_picture(s, 320);
        Scene level = s, even = s;
        level.materials[0].normal_map.texture = -1;
        even.materials[1].bump = 0;
        expect_other_picture(want, level);
        expect_other_picture(want, even);
    }
}

TEST(PathsOfTextures, CutOut) {
    Scene s = textured_room();
    s.name = "cut out";
    s.textures.push_back(picture(6, 6, [](double u, double v) {
        const double far = std::hypot(u - 0.5, v - 0.5);
        return glm::vec4(0.9, 0.5, u, far < 0.35 ? 0 : 1);
    }));
    s.textures.back().wrap_u = s.textures.back().wrap_v = Wrap::clamp;
    s.meshes.push_back(quad("board", {-1.2, 0.1, 0.4}, {2.2, 0, 0.5}, {0, 1.7, 0}, 3));
    lay_out(s.meshes.back(), 1, 1);
    s.meshes[1].material = 4; // sees the board's back, and through it
    s.materials.push_back(named("board", {1, 1, 1}));
    s.materials[3].albedo_map.texture = 1;
    s.materials[3].alpha_cutoff = 0.6F;
    s.materials.push_back(named("mirror", {0.9F, 0.9F, 0.8F}));
    s.materials[4].metallic = 1;
    s.materials[4].roughness = 0;
    const PlainPicture want = expect_same_picture(s, 320);
    Scene whole = s, more = s;
    whole.materials[3].alpha_cutoff = 0;
    more.materials[3].alpha_cutoff = 0.2F;
    expect_other_picture(want, whole);
    expect_other_picture(want, more);
}

TEST(PathsOfTextures, PatternsOfTextureCoordinates) {
    Scene s = textured_room();
    s.name = "pattern of texture coordinates";
    s.textures[0] = checks(PatternSpace::texture, 0.21);
    s.materials[0].albedo_map = {.texture = 0, .scale = {1, 1.3F}, .rotation = 0.3F};
    const PlainPicture want = expect_same_picture(s, 160);
    Scene larger = s;
    larger.textures[0].pattern->size = 0.25;
    expect_other_picture(want, larger);
}

TEST(PathsOfShapes, SubdividedCages) {
    for (const float metallic : {0.0F, 1.0F}) {
        Scene s = room();
        s.name = fmt::format("subdivided cages, metallic {}", metallic);
        Mesh block = box("block", {-1.5, 0.1, -0.6}, {1.4, 1.6, 1.2}, 25, 3), star = urchin_cage();
        block.scheme = Scheme::catmull_clark;
        for (glm::dvec3& p : star.points)
            p = 0.45 * p + glm::dvec3(0.8, 0.7, 0.6);
        star.material = 4;
        block.edge_length = star.edge_length = 1.0 / 32;
        s.meshes.push_back(block);
        s.meshes.push_back(star);
        s.materials.push_back(named("block", {0.6F, 0.7F, 0.5F}));
        s.materials.push_back(named("star", {0.8F, 0.5F, 0.4F}));
        for (const std::size_t m : {3U, 4U}) {
            s.materials[m].metallic = metallic;
            s.materials[m].roughness = 0.4F;
        }
        s.settings.diffuse_bounces = 1;
        s.settings.edge_pixels = 0.25;
        const PlainPicture want = expect_same_picture(s, 96);
        Scene flat = s;
        for (Mesh& mesh : flat.meshes)
            mesh.scheme = Scheme::bilinear;
        expect_other_picture(want, flat);
    }
}

/// A ring about a box, some or all of its edges.
TEST(PathsOfShapes, Creases) {
    const auto creased = [](float sharpness, bool all) {
        Mesh block = box("block", {-1.2, 0.1, -0.6}, {2.2, 1.8, 1.6}, 25, 3);
        block.scheme = Scheme::catmull_clark;
        block.edge_length = 1.0 / 32;
        std::vector<std::pair<int, int>> edges{{2, 3}, {3, 7}, {7, 6}, {6, 2}}; // about the top
        if (all)
            edges.insert(edges.end(), {{0, 1}, {1, 5}, {5, 4}, {4, 0}, {0, 2}, {1, 3}, {5, 7}, {4, 6}});
        for (const auto& [a, b] : edges)
            block.creases.push_back({a, b, sharpness});
        return block;
    };
    const auto scene = [](const Mesh& block) {
        Scene s = room();
        s.meshes.push_back(block);
        s.materials.push_back(named("block", {0.6F, 0.7F, 0.5F}));
        s.materials[3].metallic = 1;
        s.materials[3].roughness = 0.4F;
        s.settings.diffuse_bounces = 1;
        s.settings.edge_pixels = 0.25;
        return s;
    };
    for (const auto& [sharpness, all] :
         {std::pair(10.0F, false), std::pair(10.0F, true), std::pair(2.0F, false), std::pair(1.5F, true)}) {
        Scene s = scene(creased(sharpness, all));
        s.name = fmt::format("creases of sharpness {}{}", sharpness, all ? " along all edges" : "");
        const PlainPicture want = expect_same_picture(s, 160);
        expect_other_picture(want, scene(creased(0, all)));
        expect_other_picture(want, scene(creased(sharpness > 2 ? 2.5F : sharpness - 1, all)));
    }
}

/// A chart of its own for each face, straight within it, so that all edges are seams.
TEST(PathsOfShapes, TexturedCages) {
    Scene s = room();
    s.name = "textured cages";
    s.settings.samples *= 2;
    Mesh block = box("block", {-1.2, 0.1, -0.6}, {2.2, 1.8, 1.6}, 25, 3),
         round = ball("ball", {1, 0.5, 0.9}, 0.6, 3);
    for (Mesh* const mesh : {&block, &round}) { // quads, and triangles besides
        mesh->scheme = Scheme::catmull_clark;
        mesh->edge_length = 1.0 / 32;
        mesh->face_varying = FaceVaryingInterpolation::all;
        int face = 0;
        for (const int size : mesh->face_sizes) {
            for (int k = 0; k < size; ++k) {
                mesh->face_texcoords.push_back(static_cast<int>(mesh->texcoords.size()));
                mesh->texcoords.emplace_back(0.13 * face + (k == 1 || k == 2 ? 0.9 : 0),
                                             k >= 2 ? 1.1 : 0.07 * face);
            }
            ++face;
        }
        s.meshes.push_back(*mesh);
    }
    s.textures = {checks(PatternSpace::texture, 0.31)};
    s.materials.push_back(named("checked", {1, 1, 1}));
    s.materials.back().albedo_map.texture = 0;
    s.settings.diffuse_bounces = 1;
    s.settings.edge_pixels = 0.1;
    const PlainPicture want = expect_same_picture(s, 320);
    Scene smooth = s, plain = s;
    for (Mesh& mesh : smooth.meshes)
        mesh.face_varying = FaceVaryingInterpolation::none;
    plain.materials[3].albedo_map.texture = -1;
    plain.materials[3].albedo = {0.5F, 0.5F, 0.5F};
    expect_other_picture(want, plain);
    expect_other_picture(want, smooth);
}

/// A group placed three times, turned, stretched and mirrored, with materials and a pattern of its own.
TEST(PathsOfShapes, Instances) {
    Scene s = room();
    s.name = "instances";
    s.textures = {checks(PatternSpace::object, 0.4)};
    s.materials.push_back(named("checked", {1, 1, 1}));
    s.materials.back().albedo_map.texture = 0;
    s.materials.push_back(named("metal", {0.9F, 0.7F, 0.3F}));
    s.materials.back().metallic = 1;
    s.materials.back().roughness = 0.4F;
    s.meshes.push_back(box("box", {0, 0, 0}, {0.7, 0.9, 0.5}, 0, 3));
    s.meshes.push_back(ball("ball", {0.1, 1.2, 0.2}, 0.3, 4));
    s.graph.groups = {{"scene", {}}, {"pair", {}}};
    std::vector<Placement>& drawn = s.graph.groups[0].placements;
    std::vector<Placement>& pair = s.graph.groups[1].placements;
    for (int m = 0; m < 5; ++m) {
        Placement p;
        p.name = s.meshes[static_cast<std::size_t>(m)].name;
        p.mesh = m;
        (m < 3 ? drawn : pair).push_back(p);
    }
    const auto place = [&](const Transform& local, int material) {
        Placement p;
        p.name = "pair";
        p.group = 1;
        p.local = local;
        p.material = material;
        drawn.push_back(p);
    };
    place({.rotate = {0, 30, 0}, .translate = {-1.5, 0, -0.5}}, -1);
    place({.scale = {-0.8, 0.8, 0.8}, .rotate = {0, -20, 10}, .translate = {0.6, 0.1, 0.5}}, -1);
    place({.scale = {0.6, 0.4, 0.9}, .rotate = {0, 60, 0}, .translate = {0.2, 0, 1.4}}, 4);
    drawn.back().copies = {2, 1, 1};
    drawn.back().spacing = {0.8, 0, 0.1};
    s.settings.diffuse_bounces = 1;
    s.settings.edge_pixels = 0.1;
    const PlainPicture want = expect_same_picture(s, 160);
    Scene own = s, apart = s, turned = s;
    own.graph.groups[0].placements[5].material = -1;
    apart.graph.groups[0].placements[5].copies = {1, 1, 1};
    turned.graph.groups[0].placements[3].local.rotate = {0, 75, 0};
    for (const Scene& other : {own, apart, turned})
        expect_other_picture(want, other);
}

} // namespace
} // namespace razor::test
