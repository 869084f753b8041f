// Materials and textures as the kernels want them, and which kernels they want.
#pragma once

#include "razor/frame/kernel_table.h"
#include "razor/scene/scene.h"

#include <cstddef>
#include <vector>

namespace razor {

/// Of the materials that something drawn has; others take no room but their records.
struct MaterialTables {
    Look look = look_matte;
    std::vector<int> map_bits;         // of each material, the maps that it has: 1 << MaterialMap
    std::vector<bool> needs_texcoords; // likewise, whether some of them is other than a pattern of objects
    std::vector<bool> needs_points;    // likewise, whether some of them is a pattern of objects
    bool solid = false;                // any of all
    std::vector<bool> displaced;       // likewise, whether tessellation has one
    std::vector<DisplacementRecord> displacements;
    std::vector<MaterialRecord> materials;
    std::vector<MapRecord> maps;
    std::vector<TextureRecord> textures;
    bool cutouts = false;
    bool one_sided = false;
    SheenUse sheens = sheen_none;
    std::vector<SheenRecord> sheen_records; // first that of none; likewise:
    std::vector<float> sheen_albedo;
    std::int32_t sky_map = -1;                            // of the scene's sky, its record in `maps`
    std::vector<const std::vector<std::uint32_t>*> words; // of all textures' levels, one after the other
    std::size_t texels = 0;                               // of all
};

/// `used`: of each material, whether anything drawn has it; `by_face`: some mesh has several. Throws
/// UserError for more texels than can be numbered.
MaterialTables tabulate_materials(const Scene& scene, const std::vector<bool>& used, bool by_face);

} // namespace razor
