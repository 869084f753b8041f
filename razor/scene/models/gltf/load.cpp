// The only source that sees tinygltf. Its own file access is not used: that expands names as a shell does,
// and looks in the working folder too.
#include "razor/scene/models/gltf/container.h"
#include "razor/scene/models/gltf/document.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace razor::gltf {
namespace {

/// Required extensions that leave points, triangles, nodes and animations as they are for us: all that begins
/// so. Quantised meshes are read; anything else might change the geometry.
constexpr std::array<std::string_view, 12> harmless{
    "KHR_mesh_quantization", "KHR_materials_", "KHR_texture_",  "KHR_lights_",
    "KHR_technique",         "KHR_xmp",        "EXT_texture_",  "EXT_lights_",
    "EXT_materials_",        "MSFT_texture_",  "MSFT_packing_", "ADOBE_materials_",
};

/// Where buffers are, and how long they are stated to be, one after the other.
struct Beside {
    std::string folder;
    std::span<const std::size_t> lengths;
};

bool is_beside(const std::string& path, void* beside) {
    std::error_code error;
    return path.starts_with(static_cast<const Beside*>(beside)->folder + "/") &&
           std::filesystem::is_regular_file(path, error);
}

std::string same_path(const std::string& path, void*) {
    return path;
}

bool read_bytes(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                void* beside) {
    auto& lengths = static_cast<Beside*>(beside)->lengths;
    try {
        std::string text = read_text_file(path, "a buffer of a glTF file");
        if (!lengths.empty()) {
            text.resize(std::min(text.size(), lengths.front())); // the parser wants no more than is stated
            lengths = lengths.subspan(1);
        }
        bytes->assign(text.begin(), text.end());
        return true;
    } catch (const UserError& mistake) {
        *error = mistake.what();
        return false;
    }
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

bool ignore_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                  void*) {
    return true;
}

std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n')
        text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return printable(text, 200);
}

void check(const Container& container, const Document& document) {
    if (!container.version.starts_with("2."))
        document.fail(container.version.empty() ? "states no glTF version; export it as glTF 2.0"
                                                : fmt::format("is of glTF version {}; export it as glTF 2.0",
                                                              printable(container.version)));
    if (!container.least_version.empty() && container.least_version != "2.0")
        document.fail(fmt::format("needs a reader of glTF {}; export it as glTF 2.0",
                                  printable(container.least_version)));
    for (const std::string& name : container.required) {
        const auto begins = [&](std::string_view prefix) { return name.starts_with(prefix); };
        if (std::none_of(harmless.begin(), harmless.end(), begins))
            document.fail(fmt::format("needs the extension {}, which is not read; export it without{}",
                                      printable(name),
                                      name.find("compression") != name.npos ? " compression" : ""));
    }
    if (container.json.size() + container.binary.size() > std::numeric_limits<std::uint32_t>::max() - 64)
        document.fail("larger than 4 GiB; keep its buffers in files beside it");
}

tinygltf::Model parse(const Container& container, const std::filesystem::path& path,
                      const Document& document) {
    Beside beside{path.has_parent_path() ? path.parent_path().string() : ".", container.lengths};
    const std::string& folder = beside.folder;
    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks({is_beside, same_path, read_bytes, write_nothing, &beside});
    parser.SetImageLoader(ignore_image, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    bool done = false;
    try {
        if (container.is_binary) {
            const std::string glb = to_glb(container);
            done = parser.LoadBinaryFromMemory(&model, &error, &warning,
                                               reinterpret_cast<const unsigned char*>(glb.data()),
                                               static_cast<unsigned>(glb.size()), folder);
        } else {
            done = parser.LoadASCIIFromString(&model, &error, &warning, container.json.data(),
                                              static_cast<unsigned>(container.json.size()), folder);
        }
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!done)
        document.fail(
            fmt::format("is no complete glTF file ({}); {}", one_line(error),
                        error.starts_with("File not found") ? "put that file beside it" : "export it anew"));
    std::size_t primitives = 0;
    for (const tinygltf::Mesh& mesh : model.meshes)
        primitives += mesh.primitives.size();
    if (primitives != container.primitives) // the parser passes over what it does not understand
        document.fail(fmt::format("{} of {} mesh primitives make no sense; export it anew",
                                  container.primitives - primitives, container.primitives));
    return model;
}

Accessor to_accessor(const tinygltf::Accessor& a) {
    Accessor result{a.bufferView,
                    a.byteOffset,
                    a.count,
                    a.componentType,
                    tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)),
                    a.normalized,
                    {}};
    if (a.sparse.isSparse)
        result.sparse = SparsePart{a.sparse.count,
                                   a.sparse.indices.bufferView,
                                   a.sparse.indices.byteOffset,
                                   a.sparse.indices.componentType,
                                   a.sparse.values.bufferView,
                                   a.sparse.values.byteOffset};
    return result;
}

MeshEntry to_mesh(const tinygltf::Mesh& mesh) {
    MeshEntry result{{}, mesh.weights};
    for (const tinygltf::Primitive& p : mesh.primitives)
        result.primitives.push_back({p.attributes, p.targets, p.indices, p.mode, p.material});
    return result;
}

AnimationEntry to_animation(const tinygltf::Animation& animation) {
    AnimationEntry result{animation.name, {}, {}};
    for (const tinygltf::AnimationChannel& c : animation.channels)
        result.channels.push_back({c.sampler, c.target_node, c.target_path});
    for (const tinygltf::AnimationSampler& s : animation.samplers)
        result.samplers.push_back({s.input, s.output, s.interpolation});
    return result;
}

} // namespace

void Document::fail(std::string_view mistake) const {
    throw UserError(fmt::format("{}: {}", printable(file, 1000), mistake));
}

void Document::note(std::string_view what) const {
    std::string text = fmt::format("{}: {}", printable(file, 1000), what);
    if (std::find(notes->begin(), notes->end(), text) == notes->end())
        notes->push_back(std::move(text));
}

void fail_index(const Document& document, std::size_t count, int index, std::string_view kind,
                std::string_view what) {
    document.fail(
        fmt::format("{} names {} {}, but the file has {}; export it anew", what, kind, index, count));
}

Document load_document(const std::filesystem::path& path) {
    Document document;
    document.file = path.string();
    const std::string bytes = read_text_file(path, "a glTF file");
    const Container container = open_container(bytes, document.file);
    check(container, document);
    tinygltf::Model model = parse(container, path, document);
    for (tinygltf::Buffer& buffer : model.buffers)
        document.buffers.push_back(std::move(buffer.data));
    for (const tinygltf::BufferView& v : model.bufferViews)
        document.views.push_back({v.buffer, v.byteOffset, v.byteLength, v.byteStride});
    for (const tinygltf::Accessor& accessor : model.accessors)
        document.accessors.push_back(to_accessor(accessor));
    for (const tinygltf::Mesh& mesh : model.meshes)
        document.meshes.push_back(to_mesh(mesh));
    for (const tinygltf::Node& n : model.nodes)
        document.nodes.push_back(
            {n.name, n.translation, n.rotation, n.scale, n.matrix, n.weights, n.children, n.mesh, n.skin});
    for (const tinygltf::Skin& skin : model.skins)
        document.skins.push_back({skin.joints, skin.inverseBindMatrices});
    for (const tinygltf::Animation& animation : model.animations)
        document.animations.push_back(to_animation(animation));
    for (const tinygltf::Scene& scene : model.scenes)
        document.scenes.push_back(scene.nodes);
    document.scene = model.defaultScene;
    document.appearance = container.appearance;
    document.stage = container.stage;
    return document;
}

} // namespace razor::gltf
