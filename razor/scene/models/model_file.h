// What files hold by their names' extensions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace razor {

/// `still`: one cage (OBJ, PLY); `sequence`: such a file a frame, with %d in the name.
enum class ModelFile : std::uint8_t { none, still, sequence, md3, gltf };

/// In any case.
ModelFile model_file(const std::filesystem::path& path);

/// Whether it is of a format that splits points where normals differ, and knows no creases (hard_edges.h).
bool has_split_points(const std::filesystem::path& path);

/// With its dot, in lower case.
std::string lower_extension(const std::filesystem::path& path);

/// All that scenes are read from, for messages.
inline constexpr std::string_view scene_extensions = ".toml, .obj, .ply, .md3, .gltf, .glb or .instances";

} // namespace razor
