#include "razor/scene/graph/flatten.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace razor {
namespace {

constexpr double largest_world_coordinate = 1e30; // as of mesh points: see razor/surface/limits.h
constexpr double largest_bound = 1.01 * largest_world_coordinate; // bounds are a little larger than points
constexpr double least_scale = 1e-30, largest_scale = 1e30;
constexpr double least_rate = 1e-6, largest_rate = 1e6;
constexpr int largest_level_offset = 64;

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

const Placement* placement_of(const FlatNode& node, const SceneGraph& graph) {
    return node.placement < 0 ? nullptr : &graph.groups[at(node.group)].placements[at(node.placement)];
}

std::int64_t copies_of(const Placement& placement) {
    const auto n = glm::i64vec3(placement.copies);
    return std::min(n.x * n.y, most_flat_nodes + 1) * n.z;
}

struct Walk {
    std::vector<int> children_first; // every group after all that it places
    std::vector<int> cycle;          // or groups that contain each other, and the walk ended there
};

/// Depth first, with a stack of its own: nesting may be deep.
Walk walk(const SceneGraph& graph) {
    enum class State : std::uint8_t { fresh, open, done };
    Walk result;
    std::vector<State> state(graph.groups.size(), State::fresh);
    std::vector<std::size_t> next(graph.groups.size(), 0);
    std::vector<int> open;
    for (int root = 0; root < static_cast<int>(graph.groups.size()); ++root) {
        if (state[at(root)] == State::fresh) {
            state[at(root)] = State::open;
            open.push_back(root);
        }
        while (!open.empty()) {
            const int group = open.back();
            const std::vector<Placement>& placements = graph.groups[at(group)].placements;
            std::size_t& i = next[at(group)];
            while (i < placements.size() &&
                   (placements[i].group < 0 || state[at(placements[i].group)] == State::done)) {
                ++i;
            }
            if (i == placements.size()) {
                state[at(group)] = State::done;
                result.children_first.push_back(group);
                open.pop_back();
                continue;
            }
            const int child = placements[i].group;
            if (state[at(child)] == State::open) {
                result.cycle = {std::find(open.begin(), open.end(), child), open.end()};
                return result;
            }
            state[at(child)] = State::open;
            open.push_back(child);
        }
    }
    return result;
}

struct Count {
    std::int64_t nodes = 0, instances = 0; // at most one beyond what is allowed
};

/// What each group becomes, its own node not counted.
std::vector<Count> count_groups(const SceneGraph& graph) {
    std::vector<Count> counts(graph.groups.size());
    for (const int group : walk(graph).children_first) {
        Count& sum = counts[at(group)];
        for (const Placement& placement : graph.groups[at(group)].placements) {
            const Count each = placement.group < 0 ? Count{1, 1}
                                                   : Count{counts[at(placement.group)].nodes + 1,
                                                           counts[at(placement.group)].instances};
            const std::int64_t copies = std::min(copies_of(placement), most_flat_nodes + 1);
            sum.nodes += each.nodes * copies + (copies > 1 ? 1 : 0);
            sum.instances += each.instances * copies;
            sum.nodes = std::min(sum.nodes, most_flat_nodes + 1);
            sum.instances = std::min(sum.instances, most_instances + 1);
        }
    }
    return counts;
}

void check_cycle(const SceneGraph& graph) {
    const std::vector<int> cycle = find_cycle(graph);
    if (cycle.empty()) {
        return;
    }
    std::string names;
    for (const int group : cycle) {
        names += fmt::format("'{}' in ", printable(graph.groups[at(group)].name));
    }
    throw UserError(
        fmt::format("groups contain each other ({}'{}'); remove one of the objects that place them", names,
                    printable(graph.groups[at(cycle.front())].name)));
}

void check_size(const SceneGraph& graph) {
    const Count all = count_groups(graph).front();
    if (all.instances == 0) {
        throw UserError("the scene graph places no mesh; add an object that does");
    }
    if (all.instances > most_instances || all.nodes + 1 > most_flat_nodes) {
        throw UserError(
            fmt::format("the scene graph has more than {} instances or {} nodes; place fewer copies",
                        most_instances, most_flat_nodes));
    }
}

class Expander {
public:
    explicit Expander(const SceneGraph& graph) : graph_(graph) {}

    FlatGraph expand() {
        flat_.nodes.emplace_back();
        for (std::size_t n = 0; n < flat_.nodes.size(); ++n) {
            const auto node = static_cast<std::int32_t>(n);
            const Placement* const placement = placement_of(flat_.nodes[n], graph_);
            if (node == 0) {
                add_group(node, 0);
            } else if (placement == nullptr) {
                add_copies(node);
            } else if (placement->group >= 0) {
                add_group(node, placement->group);
            } else {
                flat_.nodes[n].instance = static_cast<std::int32_t>(flat_.instances.size());
                flat_.instances.emplace_back();
                flat_.instances.back().node = node;
                flat_.instances.back().mesh = placement->mesh;
            }
        }
        return std::move(flat_);
    }

private:
    void begin_children(std::int32_t node) {
        flat_.nodes[at(node)].first_child = static_cast<std::int32_t>(flat_.nodes.size());
    }
    void end_children(std::int32_t node) {
        FlatNode& parent = flat_.nodes[at(node)];
        parent.child_count = static_cast<std::int32_t>(flat_.nodes.size()) - parent.first_child;
    }
    FlatNode& add(std::int32_t parent, std::int32_t group, std::int32_t placement) {
        FlatNode& child = flat_.nodes.emplace_back();
        child.parent = parent;
        child.group = group;
        child.placement = placement;
        return child;
    }

    void add_group(std::int32_t node, std::int32_t group) {
        begin_children(node);
        const std::vector<Placement>& placements = graph_.groups[at(group)].placements;
        for (std::size_t i = 0; i < placements.size(); ++i) {
            const auto placement = static_cast<std::int32_t>(i);
            if (copies_of(placements[i]) == 1) {
                add(node, group, placement);
            } else {
                arrays_.push_back({group, placement});
                add(node, -1, -1);
            }
        }
        end_children(node);
    }

    /// Array nodes are reached in the order in which they were added.
    void add_copies(std::int32_t node) {
        const Array array = arrays_[next_array_++];
        const Placement& placement = graph_.groups[at(array.group)].placements[at(array.placement)];
        begin_children(node);
        for (int k = 0; k < placement.copies.z; ++k) {
            for (int j = 0; j < placement.copies.y; ++j) {
                for (int i = 0; i < placement.copies.x; ++i) {
                    add(node, array.group, array.placement).copy_offset =
                        glm::dvec3(i, j, k) * placement.spacing;
                }
            }
        }
        end_children(node);
    }

    struct Array {
        std::int32_t group, placement;
    };
    const SceneGraph& graph_;
    FlatGraph flat_;
    std::vector<Array> arrays_;
    std::size_t next_array_ = 0;
};

/// What a node inherits and hands down.
struct Inherited {
    int level_offset = 0;
    double rate = 1;
    int material = -1;
};

[[noreturn]] void fail(const FlatGraph& flat, const SceneGraph& graph, std::int32_t node,
                       std::string_view what) {
    throw UserError(fmt::format("object '{}' {}", path_of(flat, graph, node), what));
}

/// A number that is not the bound, in digits that show it.
std::string told_from(double number, double bound) {
    const std::string text = fmt::format("{:g}", number);
    return text == fmt::format("{:g}", bound) ? fmt::format("{}", number) : text;
}

void check_scale(const FlatGraph& flat, const SceneGraph& graph, std::int32_t node,
                 const glm::dvec3& singular) {
    if (!(singular.x <= largest_scale) || (singular.x < least_scale && singular.x > 0)) {
        fail(flat, graph, node,
             fmt::format("is scaled by {} in the world; keep scales from {:g} to {:g}",
                         told_from(singular.x, singular.x < 1 ? least_scale : largest_scale), least_scale,
                         largest_scale));
    }
    if (!(singular.z > 0 && singular.z >= least_relative_scale * singular.x)) {
        fail(flat, graph, node,
             fmt::format(
                 "is flattened: its world transform scales by {:g} in one direction and by {:g} in another, "
                 "a ratio below {:g}; make it thicker",
                 singular.x, singular.z, least_relative_scale));
    }
}

/// sigma, or the power of two it is meant to be: rotations leave rounding behind.
double without_rounding(double sigma) {
    const double power = std::exp2(std::round(std::log2(sigma)));
    return std::abs(sigma - power) <= 1e-12 * power ? power : sigma;
}

/// Of the instance at a leaf, what follows from its world transform.
void derive_scale(FlatGraph& flat, const SceneGraph& graph, std::int32_t node) {
    FlatInstance& instance = flat.instances[at(flat.nodes[at(node)].instance)];
    const glm::dvec3 singular = singular_values(flat.nodes[at(node)].world.linear);
    check_scale(flat, graph, node, singular);
    instance.scale = without_rounding(singular.x);
    instance.level_offset =
        instance.stated_level_offset - static_cast<int>(std::lround(std::log2(instance.scale)));
}

void derive_instance(FlatGraph& flat, const SceneGraph& graph, std::int32_t node,
                     const Inherited& inherited) {
    FlatInstance& instance = flat.instances[at(flat.nodes[at(node)].instance)];
    if (!(inherited.rate >= least_rate && inherited.rate <= largest_rate)) {
        fail(flat, graph, node,
             fmt::format("has rates that multiply to {:g}; keep the product from {:g} to {:g}",
                         inherited.rate, least_rate, largest_rate));
    }
    if (std::abs(inherited.level_offset) > largest_level_offset) {
        fail(flat, graph, node,
             fmt::format("has level offsets that add up to {}; keep the sum from {} to {}",
                         inherited.level_offset, -largest_level_offset, largest_level_offset));
    }
    instance.stated_level_offset = inherited.level_offset;
    instance.rate = inherited.rate;
    instance.material = inherited.material;
}

void place_node(FlatNode& node, const Affine& parent, const Placement* placement) {
    node.world = parent;
    if (placement != nullptr) {
        Affine local = to_affine(placement->local);
        local.translation += node.copy_offset;
        node.world = parent * local;
    }
}

void bound_leaf(FlatGraph& flat, const SceneGraph& graph, std::int32_t node,
                std::span<const Box> mesh_bounds) {
    FlatNode& leaf = flat.nodes[at(node)];
    leaf.bounds = bounds_of_image(leaf.world, mesh_bounds[at(flat.instances[at(leaf.instance)].mesh)]);
    const glm::dvec3 reach = glm::max(glm::abs(leaf.bounds.low), glm::abs(leaf.bounds.high));
    if (!(std::max({reach.x, reach.y, reach.z}) <= largest_bound)) {
        fail(flat, graph, node,
             fmt::format("reaches beyond {:g} in world coordinates; move or scale it",
                         largest_world_coordinate));
    }
}

} // namespace

SceneGraph drawn_graph(const SceneGraph& graph, std::size_t meshes) {
    if (!graph.groups.empty()) {
        return graph;
    }
    SceneGraph all{{{"scene", {}}}};
    for (std::size_t m = 0; m < meshes; ++m) {
        all.groups.front().placements.push_back(
            {.name = fmt::format("mesh {}", m), .mesh = static_cast<int>(m), .local = {}});
    }
    return all;
}

std::vector<int> find_cycle(const SceneGraph& graph) {
    return walk(graph).cycle;
}

FlatGraph flatten(const SceneGraph& graph, std::span<const Box> mesh_bounds) {
    check_cycle(graph);
    check_size(graph);
    FlatGraph flat = Expander(graph).expand();
    refit(flat, graph, mesh_bounds);
    return flat;
}

void refit(FlatGraph& flat, const SceneGraph& graph, std::span<const Box> mesh_bounds) {
    std::vector<Inherited> inherited(flat.nodes.size());
    for (std::size_t n = 1; n < flat.nodes.size(); ++n) {
        FlatNode& node = flat.nodes[n];
        const FlatNode& parent = flat.nodes[at(node.parent)];
        inherited[n] = inherited[at(node.parent)];
        const Placement* const placement = placement_of(node, graph);
        place_node(node, parent.world, placement);
        if (placement != nullptr) {
            inherited[n].rate *= placement->rate;
            inherited[n].level_offset =
                std::clamp(inherited[n].level_offset + placement->level_offset, -1000000, 1000000);
            if (placement->material >= 0) {
                inherited[n].material = placement->material;
            }
        }
        if (node.instance >= 0) {
            derive_instance(flat, graph, static_cast<std::int32_t>(n), inherited[n]);
            derive_scale(flat, graph, static_cast<std::int32_t>(n));
        }
    }
    for (FlatNode& node : flat.nodes) {
        node.bounds = {};
    }
    for (std::size_t n = flat.nodes.size(); n-- > 0;) {
        FlatNode& node = flat.nodes[n];
        if (node.instance >= 0) {
            bound_leaf(flat, graph, static_cast<std::int32_t>(n), mesh_bounds);
        }
        if (node.parent >= 0) {
            flat.nodes[at(node.parent)].bounds.add(node.bounds);
        }
    }
}

FlatIndex::Lists FlatIndex::sorted(std::span<const std::int32_t> list_of, std::size_t lists) {
    Lists result;
    result.first.assign(lists + 1, 0);
    for (const std::int32_t l : list_of) {
        if (l >= 0) {
            ++result.first[at(l) + 1];
        }
    }
    for (std::size_t l = 0; l < lists; ++l) {
        result.first[l + 1] += result.first[l];
    }
    result.items.resize(result.first.back());
    std::vector<std::size_t> next = result.first;
    for (std::size_t i = 0; i < list_of.size(); ++i) {
        if (list_of[i] >= 0) {
            result.items[next[at(list_of[i])]++] = static_cast<std::int32_t>(i);
        }
    }
    return result;
}

FlatIndex::FlatIndex(const FlatGraph& flat, const SceneGraph& graph, std::size_t meshes) {
    std::size_t placements = 0;
    for (const Group& group : graph.groups) {
        first_placement_.push_back(placements);
        placements += group.placements.size();
    }
    std::vector<std::int32_t> of_nodes, of_instances;
    for (const FlatNode& node : flat.nodes) {
        of_nodes.push_back(node.placement < 0 ? -1
                                              : static_cast<std::int32_t>(first_placement_[at(node.group)]) +
                                                    node.placement);
    }
    for (const FlatInstance& instance : flat.instances) {
        of_instances.push_back(instance.mesh);
    }
    placements_ = sorted(of_nodes, placements);
    meshes_ = sorted(of_instances, meshes);
}

std::span<const std::int32_t> FlatIndex::nodes_of(const PlacementName& name) const {
    return list(placements_, first_placement_[at(name.group)] + at(name.placement));
}

std::vector<std::int32_t> follow(FlatGraph& flat, const FlatIndex& index, const SceneGraph& graph,
                                 std::span<const Box> mesh_bounds, std::span<const PlacementName> moved,
                                 std::span<const int> meshes) {
    std::vector<std::int32_t> open, leaves;
    for (const PlacementName& name : moved) {
        const std::span<const std::int32_t> nodes = index.nodes_of(name);
        open.insert(open.end(), nodes.begin(), nodes.end());
    }
    // Parents come before children, so of two that are one below the other the upper is met first.
    std::make_heap(open.begin(), open.end(), std::greater<>());
    std::int32_t last = -1;
    while (!open.empty()) {
        std::pop_heap(open.begin(), open.end(), std::greater<>());
        const std::int32_t n = open.back();
        open.pop_back();
        if (n == last) {
            continue;
        }
        last = n;
        FlatNode& node = flat.nodes[at(n)];
        place_node(node, flat.nodes[at(node.parent)].world, placement_of(node, graph));
        if (node.instance >= 0) {
            derive_scale(flat, graph, n);
            leaves.push_back(node.instance);
        }
        for (std::int32_t k = 0; k < node.child_count; ++k) {
            open.push_back(node.first_child + k);
            std::push_heap(open.begin(), open.end(), std::greater<>());
        }
    }
    for (const int mesh : meshes) {
        const std::span<const std::int32_t> all = index.instances_of(at(mesh));
        leaves.insert(leaves.end(), all.begin(), all.end());
    }
    std::sort(leaves.begin(), leaves.end());
    leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
    for (const std::int32_t instance : leaves) {
        bound_leaf(flat, graph, flat.instances[at(instance)].node, mesh_bounds);
    }
    return leaves;
}

std::string path_of(const FlatGraph& flat, const SceneGraph& graph, std::int32_t node) {
    constexpr std::size_t shown = 8; // of very deep nesting, the ends
    std::vector<std::string> names;
    for (; node > 0; node = flat.nodes[at(node)].parent) {
        if (const Placement* const placement = placement_of(flat.nodes[at(node)], graph)) {
            names.push_back(printable(placement->name));
        }
    }
    std::reverse(names.begin(), names.end());
    if (names.size() > shown) {
        names.erase(names.begin() + shown / 2, names.end() - shown / 2);
        names.insert(names.begin() + shown / 2, "...");
    }
    return fmt::format("{}", fmt::join(names, "/"));
}

} // namespace razor
