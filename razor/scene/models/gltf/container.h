// What holds a glTF file together: JSON text by itself (.gltf), or in chunks with binary data (.glb).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace razor::gltf {

struct Container {
    std::string json;       // without:
    std::string appearance; // materials, textures, images and samplers, an object of these lists
    /// `cameras`, `extensions` of the file, and of each of its `nodes` camera and extensions; empty: no node
    /// has any of either.
    std::string stage;
    std::string_view binary; // of the first buffer of a .glb, part of the bytes read
    bool is_binary = false;
    std::string version;               // of glTF, as the file states it
    std::string least_version;         // that readers must know; empty: the same
    std::vector<std::size_t> lengths;  // stated, of buffers in files of their own
    std::vector<std::string> required; // extensions
    std::size_t primitives = 0;        // of all meshes
};

/// Only what shapes and motion need is left in the text, so that odd images, materials and extensions cannot
/// matter until they are used. Throws UserError, naming `file`.
Container open_container(std::string_view bytes, std::string_view file);

/// A .glb, glTF 2.0, 4.4. The parts must be smaller than 4 GiB together.
std::string to_glb(const Container& container);

} // namespace razor::gltf
