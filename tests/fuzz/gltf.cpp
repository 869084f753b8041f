// glTF: any bytes are a sound cage, still and in motion, with sound materials and nodes, or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/models/gltf_reader.h"
#include "tests/fuzz/cage.h"
#include "tests/scene/gltf_writer.h"

namespace {

/// Nodes that turn and grow, a morph target, a skin of two joints, a material.
razor::GltfWriter moving() {
    razor::GltfWriter w;
    const int points = w.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 3);
    const int uv = w.floats({0, 0, 1, 0, 0, 1, 1, 1}, 2);
    const int target = w.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const int joints = w.accessor<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0}, 4);
    const int weights = w.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, 4);
    const int indices = w.accessor<std::uint16_t>({0, 1, 3, 0, 3, 2}, 1);
    w.add("materials", {{"name", "m"}, {"pbrMetallicRoughness", {{"metallicFactor", 0.5}}}});
    w.add("meshes",
          {{"primitives",
            {{{"attributes",
               {{"POSITION", points}, {"TEXCOORD_0", uv}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
              {"indices", indices},
              {"material", 0},
              {"targets", {{{"POSITION", target}}}}}}}});
    w.add("nodes", {{"mesh", 0}, {"skin", 0}, {"children", {1, 2}}});
    w.add("nodes", {{"name", "hip"}, {"translation", {0, 1, 0}}});
    w.add("nodes", {{"name", "knee"}, {"rotation", {0, 0, 0, 1}}});
    w.add("skins", {{"joints", {1, 2}}});
    w.channel(1, "translation", {0, 1}, {0, 1, 0, 0, 2, 0}, 3);
    w.channel(2, "rotation", {0, 0.5F, 1}, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1}, 4, "STEP");
    w.channel(2, "scale", {0, 1}, {1, 1, 1, 2, 1, 0.5F}, 3);
    w.channel(0, "weights", {0, 1}, {0, 1}, 1);
    return w;
}

/// Each can carry, or it is told when it cannot.
void require_told(const razor::NamedNodes& nodes) {
    for (std::size_t n = 0; n < nodes.named().size(); ++n) {
        const std::optional<double> flat = nodes.flat_at(n, std::nullopt);
        fuzz::require(!flat || !razor::can_carry(nodes.at(n, *flat)));
        for (const double time : {0.0, 0.3, 1e9})
            fuzz::require(nodes.flat_at(n, time).has_value() != razor::can_carry(nodes.at(n, time)));
    }
}

} // namespace

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{moving().text(), moving().glb(), razor::triangle().text(),
                                              razor::triangle().glb()};
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    static const File text("fuzz.gltf"), binary("fuzz.glb");
    const File& file = bytes.starts_with("glTF") ? binary : text;
    file.write(bytes);
    try {
        razor::TextureCache textures;
        const razor::GltfModel model = razor::read_gltf(file.path(), "", 0, &textures);
        require_sound(*model.cage);
        if (model.motion) {
            for (const double time : {0.0, 0.3, 1e9})
                require_sound(*model.motion->at(time));
        }
        if (model.nodes)
            require_told(*model.nodes);
    } catch (const razor::UserError& error) {
        require_line(error.what(), file.path());
    }
    return true;
}
