#include "razor/scene/models/model_file.h"

#include "razor/scene/numbered_name.h"

#include <algorithm>

namespace razor {

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return extension;
}

ModelFile model_file(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".obj" || extension == ".ply") {
        return has_number(path.filename().string()) ? ModelFile::sequence : ModelFile::still;
    }
    if (extension == ".md3") {
        return ModelFile::md3;
    }
    return extension == ".gltf" || extension == ".glb" ? ModelFile::gltf : ModelFile::none;
}

bool has_split_points(const std::filesystem::path& path) {
    const ModelFile kind = model_file(path);
    return kind == ModelFile::md3 || kind == ModelFile::gltf;
}

} // namespace razor
