#include "razor/scene/models/gltf/named_nodes.h"

#include "razor/scene/models/gltf/nodes.h"

#include <set>

namespace razor::gltf {

std::vector<NamedNode> named_nodes(const Document& document, const Skeleton& skeleton) {
    const std::vector<int> drawn = nodes_to_draw(document, skeleton);
    std::set<int> joints, reached(drawn.begin(), drawn.end());
    for (const SkinEntry& skin : document.skins)
        joints.insert(skin.joints.begin(), skin.joints.end());
    std::vector<NamedNode> named;
    for (const int node : skeleton.order) {
        const std::string& name = document.nodes[static_cast<std::size_t>(node)].name;
        const bool joint = joints.contains(node);
        if (!name.empty() && (joint || reached.contains(node)))
            named.push_back({name, node, joint});
    }
    return named;
}

} // namespace razor::gltf
