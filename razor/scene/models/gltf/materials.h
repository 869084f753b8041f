// Materials of a glTF file, with their pictures: in files, data URIs or buffers.
//
// Material's members are those of pbrMetallicRoughness, and of KHR_materials_ior, _specular (its factor),
// _clearcoat, _transmission (their factors), _sheen and _emissive_strength. Of what is seen through its
// opacity: alphaMode MASK is cut out at alphaCutoff, BLEND at 1/2, and what a BLEND's factor lacks of 1 is
// transmitted. What transmits has two sides. Maps: KHR_texture_transform, turned to v upwards. Maps over
// texture coordinates other than TEXCOORD_0, occlusion and all else are passed over.
#pragma once

#include "razor/scene/models/gltf/document.h"
#include "razor/scene/scene.h"
#include "razor/scene/textures/texture_cache.h"

#include <filesystem>
#include <memory>

namespace razor::gltf {

class MaterialReader {
public:
    /// All three must outlive it. `folder`: of the file.
    MaterialReader(const Document& document, const std::filesystem::path& folder, TextureCache& cache);
    ~MaterialReader();

    /// The index of the file's material of that number among those of finish(); -1 for -1. Each is read when
    /// it is used first, and its pictures with it. Throws UserError.
    int use(int material);

    ModelMaterials finish();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace razor::gltf
