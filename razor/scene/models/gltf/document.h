// A glTF 2.0 file as it says itself; materials and what they use as text. Nothing in it has been checked but
// its grammar: numbers of accessors, nodes and so on may be any.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace razor::gltf {

inline constexpr int none = -1;

struct BufferView {
    int buffer = none;
    std::size_t offset = 0, length = 0;
    std::size_t stride = 0; // bytes from one element to the next; 0: they are packed
};

/// Elements that differ from the rest, and what they are.
struct SparsePart {
    int count = 0;
    int index_view = none, index_offset = 0, index_component = 0;
    int value_view = none, value_offset = 0;
};

/// Numbers in a buffer. Components: 5120 to 5126 as in glTF 2.0, 3.6.2.2.
struct Accessor {
    int view = none;
    std::size_t offset = 0, count = 0;
    int component = 0;
    int width = 0; // components an element
    bool normalized = false;
    std::optional<SparsePart> sparse{};
};

using Attributes = std::map<std::string, int>; // accessors

struct Primitive {
    Attributes attributes;
    std::vector<Attributes> targets;
    int indices = none, mode = 4, material = none;
};

struct MeshEntry {
    std::vector<Primitive> primitives;
    std::vector<double> weights;
};

struct NodeEntry {
    std::string name;                                                  // may be empty
    std::vector<double> translation, rotation, scale, matrix, weights; // empty: not given
    std::vector<int> children;
    int mesh = none, skin = none;
};

struct SkinEntry {
    std::vector<int> joints;
    int inverse_bind = none;
};

struct AnimationEntry {
    struct Channel {
        int sampler = none, node = none;
        std::string path;
    };
    struct Sampler {
        int input = none, output = none;
        std::string interpolation;
    };
    std::string name;
    std::vector<Channel> channels;
    std::vector<Sampler> samplers;
};

struct Document {
    std::string file; // name, for messages
    std::vector<std::vector<unsigned char>> buffers;
    std::vector<BufferView> views;
    std::vector<Accessor> accessors;
    std::vector<MeshEntry> meshes;
    std::vector<NodeEntry> nodes;
    std::vector<SkinEntry> skins;
    std::vector<AnimationEntry> animations;
    std::vector<std::vector<int>> scenes; // their nodes
    int scene = none;
    std::string appearance, stage; // see Container

    /// Throws UserError; `mistake`: "cause; mend".
    [[noreturn]] void fail(std::string_view mistake) const;
    /// What is read otherwise than it stands there, or not at all; said once. Found while the file is read.
    void note(std::string_view what) const;
    std::shared_ptr<std::vector<std::string>> notes = std::make_shared<std::vector<std::string>>();
};

/// `list[index]`, or UserError: "what names kind index, but the file has n".
template <class Entry>
const Entry& entry(const Document& document, const std::vector<Entry>& list, int index, std::string_view kind,
                   std::string_view what);
[[noreturn]] void fail_index(const Document& document, std::size_t count, int index, std::string_view kind,
                             std::string_view what);

/// With its buffers, also those in files beside it. Throws UserError.
Document load_document(const std::filesystem::path& path);

template <class Entry>
const Entry& entry(const Document& document, const std::vector<Entry>& list, int index, std::string_view kind,
                   std::string_view what) {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
        fail_index(document, list.size(), index, kind, what);
    return list[static_cast<std::size_t>(index)];
}

} // namespace razor::gltf
