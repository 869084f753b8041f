#include "razor/scene/models/gltf/drawn_mesh.h"

#include "razor/scene/models/gltf/accessor.h"
#include "razor/scene/models/gltf/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace razor::gltf {
namespace {

/// A mesh as the file has it: points apart where anything of them differs.
struct Vertices {
    Skin skin;
    std::vector<int> triangles, materials;
    std::vector<glm::vec2> texcoords;
    std::vector<bool> textured;     // of each point: it has one
    std::vector<glm::vec3> normals; // of each point, 0: it has none; empty: not read
};

class MeshReader {
public:
    MeshReader(const Document& document, int node, bool normals)
        : document_(document), normals_(normals), node_(document.nodes[static_cast<std::size_t>(node)]),
          mesh_(entry(document, document.meshes, node_.mesh, "mesh", fmt::format("node {}", node))) {
        vertices_.skin.node = node;
        vertices_.skin.targets.resize(target_count(mesh_));
        if (node_.skin != none)
            read_joints();
    }

    Vertices read() {
        for (std::size_t p = 0; p < mesh_.primitives.size(); ++p) {
            what_ = fmt::format("mesh {} primitive {}", node_.mesh, p);
            read_primitive(mesh_.primitives[p]);
        }
        return std::move(vertices_);
    }

private:
    void read_joints() {
        const std::string what = fmt::format("skin {}", node_.skin);
        const SkinEntry& listed = entry(document_, document_.skins, node_.skin, "skin",
                                        fmt::format("node {}", vertices_.skin.node));
        Skin& skin = vertices_.skin;
        skin.joints = listed.joints;
        if (skin.joints.empty())
            document_.fail(fmt::format("{} has no joints; export it anew", what));
        for (const int joint : skin.joints)
            entry(document_, document_.nodes, joint, "node", what);
        skin.inverse_bind.resize(skin.joints.size());
        if (listed.inverse_bind == none)
            return;
        const std::string matrices = what + " inverse bind matrices";
        const std::vector<double> m = read_numbers(document_, listed.inverse_bind, 16, 0, matrices);
        if (m.size() / 16 < skin.joints.size())
            document_.fail(fmt::format("{} are {} for {} joints; export it anew", matrices, m.size() / 16,
                                       skin.joints.size()));
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            skin.inverse_bind[j] = to_affine(document_, m.data() + 16 * j, matrices);
    }

    void read_primitive(const Primitive& primitive) {
        if (primitive.mode < 0 || primitive.mode > 6)
            document_.fail(
                fmt::format("{} has mode {}, which is not known; export triangles", what_, primitive.mode));
        if (primitive.mode < 4) {
            document_.note(fmt::format("{} is of {}, which are passed over: only triangles are drawn", what_,
                                       primitive.mode == 0 ? "points" : "lines"));
            return;
        }
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end())
            return; // nothing to draw: glTF 2.0, 3.7.2.1
        const std::vector<double> points = read_numbers(document_, position->second, 3, 0, what_ + " points");
        const std::size_t base = vertices_.skin.points.size(), count = points.size() / 3;
        if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()) - base)
            document_.fail("has more than 2^31 points; split the model");
        append(points, vertices_.skin.points);
        read_targets(primitive, count);
        if (!vertices_.skin.joints.empty())
            read_influences(primitive, count);
        read_texcoords(primitive, count);
        if (normals_)
            read_normals(primitive, count);
        append_triangles(primitive, count, static_cast<int>(base));
        vertices_.materials.resize(vertices_.triangles.size() / 3, primitive.material);
    }

    static void append(const std::vector<double>& numbers, std::vector<glm::dvec3>& points) {
        for (std::size_t i = 0; i < numbers.size(); i += 3)
            points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    }

    void read_targets(const Primitive& primitive, std::size_t count) {
        for (std::size_t t = 0; t < vertices_.skin.targets.size(); ++t) {
            auto& target = vertices_.skin.targets[t];
            const Attributes none_moved;
            const Attributes& moved = t < primitive.targets.size() ? primitive.targets[t] : none_moved;
            if (const auto position = moved.find("POSITION"); position != moved.end())
                append(read_numbers(document_, position->second, 3, count, what_ + " morph targets"), target);
            else
                target.resize(target.size() + count);
        }
    }

    void read_influences(const Primitive& primitive, std::size_t count) {
        std::vector<std::vector<double>> joints, weights; // of each set, four a point
        const std::string what = what_ + " joints and weights";
        for (int set = 0;; ++set) {
            const auto j = primitive.attributes.find(fmt::format("JOINTS_{}", set));
            const auto w = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
            if (j == primitive.attributes.end() || w == primitive.attributes.end())
                break;
            joints.push_back(read_numbers(document_, j->second, 4, count, what));
            weights.push_back(read_numbers(document_, w->second, 4, count, what));
        }
        if (joints.empty())
            document_.fail(fmt::format("{} has a skin, but no joints and weights; export it anew", what_));
        std::vector<Influence> of_point(4 * joints.size());
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < of_point.size(); ++k) {
                const double joint = joints[k / 4][4 * i + k % 4], weight = weights[k / 4][4 * i + k % 4];
                if (!(weight >= 0))
                    document_.fail(fmt::format("{} has the weight {}; export it anew", what, weight));
                if (!(joint >= 0 && joint < static_cast<double>(vertices_.skin.joints.size())))
                    document_.fail(fmt::format("{} name joint {}, but the skin has {}; export it anew", what,
                                               joint, vertices_.skin.joints.size()));
                of_point[k] = {static_cast<int>(joint), weight};
            }
            vertices_.skin.append_influences(of_point);
        }
    }

    void read_texcoords(const Primitive& primitive, std::size_t count) {
        const auto found = primitive.attributes.find("TEXCOORD_0");
        const bool textured = found != primitive.attributes.end();
        vertices_.textured.resize(vertices_.textured.size() + count, textured);
        if (!textured) {
            vertices_.texcoords.resize(vertices_.textured.size());
            return;
        }
        const std::vector<double> uv =
            read_numbers(document_, found->second, 2, count, what_ + " texture coordinates");
        for (std::size_t i = 0; i < uv.size(); i += 2)
            vertices_.texcoords.emplace_back(static_cast<float>(uv[i]), static_cast<float>(1 - uv[i + 1]));
    }

    void read_normals(const Primitive& primitive, std::size_t count) {
        const auto found = primitive.attributes.find("NORMAL");
        const std::size_t before = vertices_.normals.size();
        vertices_.normals.resize(before + count, glm::vec3(0));
        if (found == primitive.attributes.end())
            return;
        const std::vector<double> numbers =
            read_numbers(document_, found->second, 3, count, what_ + " normals");
        for (std::size_t i = 0; i < count; ++i)
            for (int axis = 0; axis < 3; ++axis)
                vertices_.normals[before + i][axis] =
                    static_cast<float>(numbers[3 * i + static_cast<std::size_t>(axis)]);
    }

    void append_triangles(const Primitive& primitive, std::size_t count, int base) {
        std::vector<std::uint32_t> indices;
        if (primitive.indices != none)
            indices = read_indices(document_, primitive.indices, what_ + " indices");
        const std::size_t corners = primitive.indices == none ? count : indices.size();
        const auto corner = [&](std::size_t i) {
            const std::size_t index = indices.empty() ? i : indices[i];
            if (index >= count)
                document_.fail(
                    fmt::format("{} names point {}, but it has {}; export it anew", what_, index, count));
            vertices_.triangles.push_back(base + static_cast<int>(index));
        };
        if (primitive.mode == 4) {
            if (corners % 3 != 0)
                document_.fail(fmt::format("{} has {} corners, which are no whole triangles; export it anew",
                                           what_, corners));
            for (std::size_t i = 0; i < corners; ++i)
                corner(i);
            return;
        }
        for (std::size_t i = 0; i + 2 < corners; ++i) { // orders of corners: glTF 2.0, 3.7.2.1
            const bool fan = primitive.mode == 6;
            corner(fan ? i + 1 : i);
            corner(fan ? i + 2 : i + 1 + i % 2);
            corner(fan ? 0 : i + 2 - i % 2);
        }
    }

    const Document& document_;
    bool normals_;
    const NodeEntry& node_;
    const MeshEntry& mesh_;
    std::string what_;
    Vertices vertices_;
};

/// For each vertex the first one with the same point and texture coordinate; -1 where it has none.
std::vector<int> first_texcoord(const Vertices& vertices, const std::vector<int>& points) {
    std::vector<int> order, first(points.size(), none);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (vertices.textured[i])
            order.push_back(static_cast<int>(i));
    const auto key = [&](int v) {
        const auto i = static_cast<std::size_t>(v);
        return std::tuple(points[i], vertices.texcoords[i].x, vertices.texcoords[i].y);
    };
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool again = k > 0 && key(order[k - 1]) == key(order[k]);
        first[static_cast<std::size_t>(order[k])] =
            again ? first[static_cast<std::size_t>(order[k - 1])] : order[k];
    }
    return first;
}

/// Numbers things anew, in order of first use.
class Renumbering {
public:
    explicit Renumbering(std::size_t count) : numbers_(count, none) {}
    int operator()(int old) {
        int& number = numbers_[static_cast<std::size_t>(old)];
        if (number == none) {
            number = static_cast<int>(used_.size());
            used_.push_back(old);
        }
        return number;
    }
    const std::vector<int>& used() const { return used_; }

private:
    std::vector<int> numbers_, used_;
};

} // namespace

DrawnMesh read_drawn_mesh(const Document& document, int node, double crease_degrees) {
    const Vertices vertices = MeshReader(document, node, crease_degrees < no_crease_angle).read();
    std::vector<glm::vec3> normals; // of corners
    const std::vector<int> points = first_alike(vertices.skin), texcoords = first_texcoord(vertices, points);
    Renumbering point(points.size()), texcoord(points.size());
    DrawnMesh drawn;
    for (std::size_t c = 0; c < vertices.triangles.size(); c += 3) {
        const auto vertex = [&](std::size_t i) {
            return static_cast<std::size_t>(vertices.triangles[c + i]);
        };
        const int p[3] = {points[vertex(0)], points[vertex(1)], points[vertex(2)]};
        if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0])
            continue;
        drawn.materials.push_back(vertices.materials[c / 3]);
        for (std::size_t i = 0; i < 3; ++i) {
            const int t = texcoords[vertex(i)];
            drawn.triangles.push_back(point(p[i]));
            drawn.corner_texcoords.push_back(t == none ? none : texcoord(t));
            if (!vertices.normals.empty())
                normals.push_back(vertices.normals[vertex(i)]);
        }
    }
    drawn.creases = hard_edges(drawn.triangles, normals, crease_degrees);
    drawn.skin = gather(vertices.skin, point.used());
    for (const int v : texcoord.used())
        drawn.texcoords.push_back(vertices.texcoords[static_cast<std::size_t>(v)]);
    return drawn;
}

} // namespace razor::gltf
