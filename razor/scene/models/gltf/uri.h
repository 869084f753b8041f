// What a glTF file's URIs hold or name: glTF 2.0, 2.8.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace razor::gltf {

/// The bytes of a data URI in base64; nothing if it is none.
std::optional<std::string> data_of_uri(std::string_view uri);

/// The path that a relative URI names: %20 and so on as what they stand for.
std::string path_of_uri(std::string_view uri);

} // namespace razor::gltf
