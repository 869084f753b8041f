#include "razor/scene/models/gltf/nodes.h"

#include "razor/scene/models/gltf/accessor.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace razor::gltf {
namespace {

/// A property of a node: finite, and as many numbers as it takes.
bool is_given(const Document& document, const std::vector<double>& numbers, std::size_t count,
              const std::string& what) {
    if (numbers.empty())
        return false;
    if (numbers.size() != count)
        document.fail(fmt::format("{} has {} numbers, not {}; export it anew", what, numbers.size(), count));
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        document.fail(fmt::format("{} has numbers that are not finite; mend the model", what));
    return true;
}

glm::dvec3 to_vector(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

SkeletonNode read_node(const Document& document, const NodeEntry& node, std::size_t number) {
    const std::string name = fmt::format("node {}", number);
    SkeletonNode result;
    if (is_given(document, node.matrix, 16, name + ".matrix")) {
        result.matrix = to_affine(document, node.matrix.data(), name + ".matrix");
    } else {
        if (is_given(document, node.translation, 3, name + ".translation"))
            result.translation = to_vector(node.translation);
        if (is_given(document, node.scale, 3, name + ".scale"))
            result.scale = to_vector(node.scale);
        if (is_given(document, node.rotation, 4, name + ".rotation")) {
            const std::vector<double>& r = node.rotation;
            result.rotation = glm::normalize(glm::dquat(r[3], r[0], r[1], r[2]));
        }
    }
    if (node.mesh != none) {
        const MeshEntry& mesh = entry(document, document.meshes, node.mesh, "mesh", name);
        const std::size_t targets = target_count(mesh);
        const bool own = !node.weights.empty();
        result.weights.assign(targets, 0.0);
        if (is_given(document, own ? node.weights : mesh.weights, targets,
                     own ? name + ".weights" : fmt::format("mesh {}.weights", node.mesh)))
            result.weights = own ? node.weights : mesh.weights;
    }
    return result;
}

Curve read_curve(const Document& document, const AnimationEntry::Sampler& sampler, Channel::Path path,
                 std::size_t weights, const std::string& what) {
    Curve curve;
    if (sampler.interpolation == "STEP")
        curve.kind = CurveKind::step;
    else if (sampler.interpolation == "CUBICSPLINE")
        curve.kind = CurveKind::cubic_spline;
    else if (sampler.interpolation != "LINEAR")
        document.fail(fmt::format("{} is interpolated by {}; export it as LINEAR", what,
                                  printable(sampler.interpolation)));
    curve.times = read_numbers(document, sampler.input, 1, 0, what + " times");
    if (!std::is_sorted(curve.times.begin(), curve.times.end()))
        document.fail(fmt::format("{} times are not in order; export it anew", what));
    const std::size_t elements = curve.times.size() * (curve.kind == CurveKind::cubic_spline ? 3 : 1);
    if (path == Channel::Path::weights) {
        curve.width = weights;
        curve.values = read_numbers(document, sampler.output, 1, elements * weights, what + " values");
        return curve;
    }
    curve.rotation = path == Channel::Path::rotation;
    curve.width = curve.rotation ? 4 : 3;
    curve.values =
        read_numbers(document, sampler.output, static_cast<int>(curve.width), elements, what + " values");
    return curve;
}

} // namespace

Affine to_affine(const Document& document, const double* m, std::string_view what) {
    constexpr double tolerance = 1e-4; // of exporters that multiply in single precision
    if (!(std::abs(m[3]) <= tolerance && std::abs(m[7]) <= tolerance && std::abs(m[11]) <= tolerance &&
          std::abs(m[15] - 1) <= tolerance))
        document.fail(fmt::format("{} has a last row that is not 0, 0, 0, 1; export it anew", what));
    return {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
}

std::size_t target_count(const MeshEntry& mesh) {
    std::size_t count = 0;
    for (const Primitive& primitive : mesh.primitives)
        count = std::max(count, primitive.targets.size());
    return count;
}

Skeleton read_skeleton(const Document& document) {
    Skeleton skeleton;
    for (std::size_t n = 0; n < document.nodes.size(); ++n)
        skeleton.nodes.push_back(read_node(document, document.nodes[n], n));
    for (std::size_t n = 0; n < document.nodes.size(); ++n) {
        for (const int child : document.nodes[n].children) {
            entry(document, document.nodes, child, "node", fmt::format("node {}", n));
            int& parent = skeleton.nodes[static_cast<std::size_t>(child)].parent;
            if (parent != none)
                document.fail(fmt::format("node {} is a child of nodes {} and {}; give each one parent",
                                          child, parent, n));
            parent = static_cast<int>(n);
        }
    }
    skeleton.order = parents_first(skeleton.nodes);
    if (skeleton.order.size() != skeleton.nodes.size()) {
        std::vector<bool> reached(skeleton.nodes.size());
        for (const int n : skeleton.order)
            reached[static_cast<std::size_t>(n)] = true;
        document.fail(fmt::format("node {} is its own ancestor, or below such a node; mend the tree",
                                  std::find(reached.begin(), reached.end(), false) - reached.begin()));
    }
    return skeleton;
}

std::vector<int> nodes_to_draw(const Document& document, const Skeleton& skeleton) {
    if (document.scenes.empty())
        return skeleton.order;
    const auto& scene =
        entry(document, document.scenes, document.scene == none ? 0 : document.scene, "scene", "the file");
    std::vector<bool> drawn(skeleton.nodes.size());
    for (const int n : scene) {
        entry(document, document.nodes, n, "node", "the scene");
        drawn[static_cast<std::size_t>(n)] = true;
    }
    std::vector<int> result;
    for (const int i : skeleton.order) {
        const auto n = static_cast<std::size_t>(i);
        const int parent = skeleton.nodes[n].parent;
        drawn[n] = drawn[n] || (parent != none && drawn[static_cast<std::size_t>(parent)]);
        if (drawn[n])
            result.push_back(i);
    }
    return result;
}

std::vector<std::string> clip_names(const Document& document) {
    std::vector<std::string> names;
    for (const AnimationEntry& animation : document.animations)
        names.push_back(animation.name.empty() ? fmt::format("clip {}", names.size()) : animation.name);
    return names;
}

std::size_t find_clip(const Document& document, const std::vector<std::string>& clips,
                      const std::string& name) {
    const auto found = std::find(clips.begin(), clips.end(), name);
    if (found == clips.end()) {
        std::string list;
        for (const std::string& clip : clips)
            list += fmt::format("{}{}", list.empty() ? "" : ", ", printable(clip));
        document.fail(fmt::format("no animation is named '{}'; {}", printable(name),
                                  list.empty() ? "the file has none" : "there are: " + list));
    }
    return static_cast<std::size_t>(found - clips.begin());
}

Clip read_clip(const Document& document, const Skeleton& skeleton, std::size_t number) {
    const AnimationEntry& animation = document.animations[number];
    Clip clip{clip_names(document)[number], {}};
    for (std::size_t c = 0; c < animation.channels.size(); ++c) {
        const AnimationEntry::Channel& channel = animation.channels[c];
        const std::string what = fmt::format("animation {} channel {}", number, c);
        constexpr std::string_view paths[] = {"translation", "rotation", "scale", "weights"};
        const auto* const path = std::find(std::begin(paths), std::end(paths), channel.path);
        if (channel.node == none || path == std::end(paths))
            continue; // moves what only extensions know
        entry(document, document.nodes, channel.node, "node", what);
        const SkeletonNode& node = skeleton.nodes[static_cast<std::size_t>(channel.node)];
        const auto moves = static_cast<Channel::Path>(path - std::begin(paths));
        if (moves == Channel::Path::weights ? node.weights.empty() : node.matrix.has_value()) {
            if (moves == Channel::Path::weights)
                continue;
            document.fail(fmt::format("{} moves node {}, which has a matrix; export it with translation, "
                                      "rotation and scale",
                                      what, channel.node));
        }
        clip.channels.push_back(
            {channel.node, moves,
             read_curve(document, entry(document, animation.samplers, channel.sampler, "sampler", what),
                        moves, node.weights.size(), what)});
    }
    return clip;
}

} // namespace razor::gltf
