#include "razor/scene/models/gltf_contents.h"

#include "razor/scene/models/gltf/named_nodes.h"
#include "razor/scene/models/gltf/nodes.h"
#include "razor/scene/models/gltf/stage.h"

#include <utility>

namespace razor {

GltfContents read_gltf_contents(const std::filesystem::path& path) {
    const gltf::Document document = gltf::load_document(path);
    const Skeleton skeleton = gltf::read_skeleton(document);
    gltf::Stage stage = gltf::read_stage(document, gltf::nodes_to_draw(document, skeleton));
    GltfContents contents{path.string(),
                          std::move(stage.cameras),
                          std::move(stage.lights),
                          {},
                          gltf::named_nodes(document, skeleton)};
    for (std::size_t n = 0; n < document.animations.size(); ++n) {
        const Clip clip = gltf::read_clip(document, skeleton, n);
        contents.clips.push_back({clip.name, clip.length()});
    }
    return contents;
}

} // namespace razor
