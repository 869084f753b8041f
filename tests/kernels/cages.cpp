#include "tests/kernels/cages.h"

#include "razor/scene/default_scene.h"
#include "razor/scene/description.h"
#include "razor/scene/models/obj_reader.h"
#include "razor/scene/shapes/shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace razor::test {

namespace {

void add_face(Mesh& mesh, std::initializer_list<int> corners) {
    mesh.face_sizes.push_back(static_cast<int>(corners.size()));
    mesh.face_vertices.insert(mesh.face_vertices.end(), corners);
}

struct Box {
    glm::dvec3 low{1e300}, high{-1e300};
};
Box box_of(const Mesh& mesh) {
    Box b;
    for (const glm::dvec3& p : mesh.points) {
        b.low = glm::min(b.low, p);
        b.high = glm::max(b.high, p);
    }
    return b;
}

Mesh shape(const char* name) {
    const ShapeKind* kind = find_shape_kind(name);
    std::vector<double> values;
    for (const ShapeParameter& p : kind->parameters)
        values.push_back(p.preset);
    Mesh mesh = kind->make(values);
    mesh.name = name;
    return mesh;
}

} // namespace

Mesh cube_cage() {
    Mesh m;
    m.name = "cube";
    for (int i = 0; i < 8; ++i)
        m.points.emplace_back((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    add_face(m, {0, 2, 3, 1});
    add_face(m, {4, 5, 7, 6});
    add_face(m, {0, 1, 5, 4});
    add_face(m, {2, 6, 7, 3});
    add_face(m, {0, 4, 6, 2});
    add_face(m, {1, 3, 7, 5});
    return m;
}

Mesh torus_cage(int rings, int sides) {
    Mesh m;
    m.name = "torus";
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            double a = 2 * std::numbers::pi * i / rings;
            double b = 2 * std::numbers::pi * j / sides;
            double r = 1 + 0.4 * std::cos(b);
            m.points.emplace_back(r * std::cos(a), 0.4 * std::sin(b), r * std::sin(a));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sides; ++j) {
            int next_i = (i + 1) % rings;
            int next_j = (j + 1) % sides;
            add_face(m, {i * sides + j, i * sides + next_j, next_i * sides + next_j, next_i * sides + j});
        }
    return m;
}

Mesh urchin_cage() {
    return shape("urchin");
}

Mesh stretched(Mesh mesh) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> jitter(-1, 1);
    Box box = box_of(mesh);
    glm::dvec3 size = box.high - box.low;
    glm::dvec3 centre = (box.low + box.high) * 0.5;
    for (glm::dvec3& p : mesh.points) {
        glm::dvec3 q = (p - centre) / size;
        q *= 0.3 + 4.0 * glm::abs(q);
        for (int k = 0; k < 3; ++k)
            q[k] += 0.05 * jitter(random);
        p = q * glm::dvec3(1, 3, 0.4);
    }
    mesh.name += " stretched";
    return mesh;
}

Mesh tapered_cage() {
    Mesh m = cube_cage();
    m.name = "tapered";
    for (glm::dvec3& p : m.points)
        if (p.y > 0)
            p = {p.x / 32, p.y, p.z / 32};
    // Or the surface would round the small end off, and its sides would be no shorter than a quarter.
    for (const auto& [a, b] : {std::pair{2, 6}, {6, 7}, {7, 3}, {3, 2}})
        m.creases.push_back({a, b, 10});
    return m;
}

Mesh bevelled_slab() {
    constexpr double half_height = 0.1, bevel = 0.02;
    constexpr double rings[][2] = {{-half_height, bevel},
                                   {-half_height + bevel, 0},
                                   {half_height - bevel, 0},
                                   {half_height, bevel}}; // height, inset
    Mesh m;
    m.name = "bevelled slab";
    for (const auto& [height, inset] : rings)
        for (const auto& [x, z] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
            m.points.emplace_back((0.5 - inset) * x, height, (0.5 - inset) * z);
    add_face(m, {0, 1, 2});
    add_face(m, {0, 2, 3});
    for (int ring = 0; ring < 12; ring += 4)
        for (int k = 0; k < 4; ++k) {
            const int next = (k + 1) % 4;
            add_face(m, {ring + k, ring + 4 + k, ring + 4 + next});
            add_face(m, {ring + k, ring + 4 + next, ring + next});
        }
    add_face(m, {12, 14, 13});
    add_face(m, {12, 15, 14});
    return m;
}

Mesh bilinear(Mesh mesh) {
    mesh.scheme = Scheme::bilinear;
    mesh.name += " bilinear";
    return mesh;
}

std::optional<Mesh> shared_mesh(const std::string& path) {
    std::filesystem::path file = std::filesystem::path(RAZOR_SHARED_SCENES) / path;
    if (!std::filesystem::exists(file))
        return {};
    return read_obj(file);
}

Scene scene_of(const Mesh& mesh, double edges_across) {
    Box box = box_of(mesh);
    double size = glm::length(box.high - box.low);
    glm::dvec3 centre = (box.low + box.high) * 0.5;
    Scene s;
    s.name = mesh.name;
    s.meshes.push_back(mesh);
    s.meshes.back().edge_length = size / edges_across;
    s.materials.push_back({"grey", {0.6F, 0.5F, 0.4F}});
    Light light;
    light.corner = centre + glm::dvec3(-0.5, 1.2, 0.8) * size;
    light.edge_u = glm::dvec3(0.6, 0, 0) * size;
    light.edge_v = glm::dvec3(0, 0.2, -0.6) * size;
    if (glm::dot(glm::cross(light.edge_u, light.edge_v), centre - light.corner) < 0)
        std::swap(light.edge_u, light.edge_v);
    light.radiance = {9, 8, 7};
    s.lights.push_back(light);
    s.sky = {0.2F, 0.3F, 0.4F};
    s.camera.position = centre + glm::dvec3(0.3, 0.4, 1.3) * size;
    s.camera.target = centre;
    s.camera.fov_degrees = 50;
    s.settings = {
        .lod = Lod::object, .width = 32, .height = 32, .samples = 1, .light_samples = 2, .sky_samples = 2};
    return s;
}

Scene instances_of(const Mesh& mesh, double edges_across) {
    Scene s = scene_of(mesh, edges_across);
    const Box box = box_of(mesh);
    const double apart = 1.3 * glm::length(box.high - box.low);
    const auto mesh_at = [&](double x, double y, Transform local) {
        local.translate = glm::dvec3(x, y, 0) * apart;
        return Placement{.name = "mesh", .mesh = 0, .local = local};
    };
    Affine shear;
    shear.linear = {{1.1, 0.2, 0}, {-0.6, 0.9, 0.1}, {0.3, 0, 0.7}};
    shear.translation = glm::dvec3(1, 1, 0) * apart;
    Placement nested{.name = "group", .group = 1, .local = {.rotate = {0, 200, 0}}};
    nested.local.translate = glm::dvec3(2, 1, 0) * apart;
    s.graph.groups = {{"scene",
                       {mesh_at(0, 0, {}),
                        mesh_at(1, 0, {}),
                        mesh_at(2, 0, {.rotate = {25, 70, -110}}),
                        mesh_at(0, 1, {.scale = {-1.3, 0.6, 0.8}, .rotate = {0, 35, 10}}),
                        {.name = "sheared", .mesh = 0, .local = {.matrix = shear}},
                        nested}},
                      {"group", {mesh_at(0.03, 0.02, {.scale = glm::dvec3(0.37)})}}};
    s.camera.target += glm::dvec3(1, 0.5, 0) * apart;
    s.camera.position += glm::dvec3(1, 0.5, 2) * apart;
    return s;
}

Scene small_default_scene(int width, int height) {
    Scene s = build_scene(default_scene());
    s.settings.width = width;
    s.settings.height = height;
    s.settings.samples = 1;
    s.settings.light_samples = 2;
    s.settings.sky_samples = 2;
    return s;
}

bool is_closed(const Mesh& mesh) {
    std::map<std::pair<int, int>, int> faces;
    std::size_t first = 0;
    for (int n : mesh.face_sizes) {
        for (int i = 0; i < n; ++i) {
            int a = mesh.face_vertices[first + static_cast<std::size_t>(i)];
            int b = mesh.face_vertices[first + static_cast<std::size_t>((i + 1) % n)];
            ++faces[std::minmax(a, b)];
        }
        first += static_cast<std::size_t>(n);
    }
    for (const auto& [edge, count] : faces)
        if (count != 2)
            return false;
    return mesh.holes.empty();
}

std::vector<std::string> scene_names() {
    return {"cube",
            "torus_stretched",
            "urchin",
            "urchin_stretched",
            "torus_bilinear",
            "default",
            "bevelled_slab",
            "cube_bilinear_stretched",
            "urchin_bilinear",
            "catmark_car",
            "spot",
            "female_generic",
            "instances",
            "instances_bilinear"};
}

std::vector<std::string> single_mesh_scenes() {
    std::vector<std::string> names = scene_names();
    std::erase_if(names, [](const std::string& name) {
        return name == "default" || name.find("instances") != std::string::npos;
    });
    return names;
}

std::optional<NamedScene> named_scene(const std::string& name) {
    auto of = [&](const Mesh& mesh, double edges_across) {
        return NamedScene{name, scene_of(mesh, edges_across), is_closed(mesh)};
    };
    auto of_shared = [&](const char* path, double edges_across) -> std::optional<NamedScene> {
        std::optional<Mesh> mesh = shared_mesh(path);
        if (!mesh)
            return {};
        return of(*mesh, edges_across);
    };
    if (name == "cube")
        return of(cube_cage(), 60);
    if (name == "torus_stretched")
        return of(stretched(torus_cage(9, 6)), 90);
    if (name == "urchin")
        return of(urchin_cage(), 70);
    if (name == "urchin_stretched")
        return of(stretched(urchin_cage()), 90);
    if (name == "torus_bilinear")
        return of(bilinear(stretched(torus_cage(9, 6))), 60);
    if (name == "bevelled_slab")
        return of(bevelled_slab(), 40);
    if (name == "tapered")
        return of(tapered_cage(), 200);
    if (name == "cube_bilinear_stretched")
        return of(bilinear(stretched(cube_cage())), 40);
    if (name == "urchin_bilinear")
        return of(bilinear(stretched(urchin_cage())), 60);
    if (name == "instances")
        return NamedScene{name, instances_of(stretched(torus_cage(16, 9)), 40), true};
    if (name == "instances_bilinear")
        return NamedScene{name, instances_of(bilinear(stretched(urchin_cage())), 30), true};
    if (name == "default")
        return NamedScene{name, small_default_scene(24, 24), false};
    if (name == "catmark_car")
        return of_shared("osd/catmark_car.obj", 50);
    if (name == "spot")
        return of_shared("spot/spot_quadrangulated.obj", 120);
    if (name == "female_generic")
        return of_shared("makehuman/female_generic.obj", 60);
    return {};
}

} // namespace razor::test
