// What surfaces are made of, as kernels read it.
#pragma once

#include "razor/frame/line.h"

namespace razor {

/// What a surface is made of, if some surface of the scene is more than matte: see razor/scene/material.h.
struct alignas(line_bytes) MaterialRecord {
    float albedo[3];
    float metallic, roughness;
    float specular;
    float normal_reflection; // of a dielectric, at normal incidence, without the weight `specular`
    float ior, transmission;
    float coat, coat_roughness;
    float emission[3];
    float normal_scale;
    float bump;                // how high a bump map's 1 lies over its 0, in units of the object
    std::int32_t map[6];       // of each MaterialMap before map_sheen: a MapRecord, or -1
    float alpha_cutoff;        // 0: nothing is cut out
    std::int32_t map_bits;     // of the maps that it has: 1 << MaterialMap
    std::int32_t one_sided;    // not 0: seen from the front only
    std::int32_t sheen;        // words from FrameHeader::sheen_records to its SheenRecord
    float light_density;       // by area, of rays to all surfaces that are lights; 0: none goes to its own
    std::int32_t displacement; // a DisplacementRecord, or -1
    std::int32_t padding[4];
};
static_assert(sizeof(MaterialRecord) == 2 * line_bytes);
inline constexpr int material_stride = sizeof(MaterialRecord) / 4;

/// Of what fibres reflect: few materials have any, so it lies apart. The first is that of none.
struct alignas(line_bytes) SheenRecord {
    float colour[3];
    float roughness;
    float alpha;         // its square, where it has no map
    std::int32_t table;  // its albedo: words of FrameHeader::sheen_albedo from there
    std::int32_t map[2]; // of the colour, of the roughness: a MapRecord, or -1
    /// Of mapped roughness the table has rows, at even steps of its root: see SheenRows.
    float first_root, per_root, last_row;
    std::int32_t padding[5];
};
static_assert(sizeof(SheenRecord) == line_bytes);
inline constexpr int sheen_stride = sizeof(SheenRecord) / 4;

/// The most that some material has: sheen; maps of it; of its roughness, so that tables have rows.
enum SheenUse : std::int32_t { sheen_none, sheen_plain, sheen_mapped, sheen_rows };

enum MaterialMap : std::int32_t {
    map_albedo,
    map_metallic,
    map_roughness,
    map_emission,
    map_normal,
    map_bump,
    map_sheen,
    map_sheen_roughness,
    map_count
};

/// What textures make of a surface at vertices of its grids, before any ray is shaded there (phase one): an
/// instance's maps of which some material has one, as bits 1 << MaterialMap, and the arrays that each needs.
/// Bump maps bend normals, as normal maps do, which then have a bit.
constexpr int shaded_arrays(int map) {
    const bool number = map == map_metallic || map == map_roughness || map == map_sheen_roughness;
    return map == map_bump ? 0 : number ? 1 : 3;
}
constexpr int most_shaded_arrays() {
    int sum = 0;
    for (int map = 0; map < map_count; ++map)
        sum += shaded_arrays(map);
    return sum;
}

/// InstanceRecord::shading: which arrays follow the normals of a block. Two of texture coordinates; three of
/// where vertices are while the mesh is at rest (FrameHeader::rest_points); those of what is shaded, in the
/// order of MaterialMap; whose bits.
constexpr std::int32_t pack_shading(bool texcoords, bool rest, int arrays, int bits) {
    return (texcoords ? 2 : 0) | (rest ? 4 : 0) | arrays << 4 | bits << 8;
}
static_assert(most_shaded_arrays() <= 15);
template <class Int> constexpr Int texcoord_arrays(Int shading) {
    return shading & 2;
}
template <class Int> constexpr Int rest_arrays(Int shading) {
    Int some = (shading >> 2) & 1;
    return some * 3;
}
template <class Int> constexpr Int shaded_arrays_in(Int shading) {
    return (shading >> 4) & 15;
}
template <class Int> constexpr Int shaded_bits(Int shading) {
    return shading >> 8;
}

constexpr std::int32_t map_bit(int map) {
    return std::int32_t{1} << map;
}
inline constexpr std::int32_t normal_bits = 3 * map_bit(map_normal); // what bends normals
static_assert(map_bump == map_normal + 1);
inline constexpr std::int32_t sheen_bits = map_bit(map_sheen) + map_bit(map_sheen_roughness);

/// A texture where a material uses it: at (row_u . (u, v, 1), row_v . (u, v, 1)).
struct MapRecord {
    float row_u[3], row_v[3];
    std::int32_t texture;
    std::int32_t padding;
};
static_assert(sizeof(MapRecord) == line_bytes / 2);

/// By what surfaces of a material leave where their cage has them, along the normal: scale * (height -
/// midlevel), in the mesh's units.
struct alignas(line_bytes) DisplacementRecord {
    float scale, midlevel;
    float bound;      // of the product, either way
    float range;      // of the heights, times |scale|
    std::int32_t map; // a MapRecord; its texture is a pattern, or its texels are the bits of floats
    float footprint;  // |determinant of the map| * (the texture's size, or a pattern's cells a unit)^2
    std::int32_t padding[10];
    /// How fast heights of each level change, at most, per unit of the map's coordinates, times |scale|.
    float slope_u[16], slope_v[16];
};
static_assert(sizeof(DisplacementRecord) == 3 * line_bytes);

enum TextureWrap : std::int32_t { wrap_repeat, wrap_clamp, wrap_mirror };

/// A picture, or what razor/kernels/pattern_value.h makes.
enum TextureKind : std::int32_t {
    texture_image,
    texture_checker,
    texture_bricks,
    texture_noise,
    texture_turbulence,
    texture_marble,
    texture_wood
};
/// What patterns are functions of: texture coordinates, or points of objects.
enum TextureSpace : std::int32_t { texture_of_surface, texture_of_object };

/// Where the texels of each level lie, as razor/scene/texture.h says, counted from FrameHeader::texels.
struct alignas(line_bytes) TextureRecord {
    std::int32_t levels, wrap_u, wrap_v;
    float size;           // sqrt(width * height) of the finest level
    std::int32_t opacity; // words from each level's texels to its opacity; 0: all is opaque
    std::int32_t kind;    // a TextureKind. Of patterns:
    std::int32_t space, octaves;
    float gain, per_cell, amount; // see Pattern; cells a unit
    std::int32_t padding[5];
    std::int32_t first[16], width[16], height[16];
    float low[3], high[3]; // colours
    std::int32_t padding2[10];
};
static_assert(sizeof(TextureRecord) == 5 * line_bytes);

/// From an instance's own coordinates to those of its object, for patterns: row . (p, 1).
struct alignas(line_bytes) SolidRecord {
    float row[3][4];
    float shrink; // of lengths
    std::int32_t padding[3];
};
static_assert(sizeof(SolidRecord) == line_bytes);

} // namespace razor
