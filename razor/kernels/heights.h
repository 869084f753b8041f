// Heights by which surfaces are displaced: what a face's material says, and the height at texture
// coordinates, of a picture or a pattern. Whoever asks for a place gets the same bits, as all of it is a
// function of the face and the coordinates.
//
// The map is filtered to the mesh's spacing at level 0, whatever level asks: then a vertex has one place at
// all levels, so that what moves towards it, or stands for finer ones, does as it does on any surface. What
// that costs: far from where level 0 is asked for, vertices are samples of heights that are finer than their
// spacing. They stay where they are on the surface, so nothing swims.
#pragma once

#include "razor/kernels/pattern_value.h"
#include "razor/kernels/rounding.h"
#include "razor/kernels/texels.h"
#include "razor/kernels/texture_face.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

/// Finer vertices are bounded by what is measured between those of a block or of a curve's chunk: of texture
/// coordinates, which may be smooth, with room for their curvature; of normals, twice their distances from
/// the means of their neighbours, as from level to level those of a smooth surface fall to a quarter, and at
/// worst to about a half. With fewer segments than that nothing is measured; then normals are off by 2 at
/// most.
inline constexpr float texcoord_slack = 1.25F;
inline constexpr float turn_slack = 2.0F;
inline constexpr int least_measured = 4;
inline constexpr float most_turn = 2.0F;

/// One level of a pyramid of heights.
struct HeightLevel {
    sint width, height, first;
};

/// How one face is displaced.
struct Displacing {
    sbool any; // or the face stays where it is; then nothing else holds
    pointer<DisplacementRecord> record;
    pointer<float> texels;
    svec row_u, row_v;
    sint wrap_u, wrap_v;
    sfloat scale, midlevel, bound;
    pointer<TextureRecord> texture;
    sint kind;         // a TextureKind. Of a pattern:
    sfloat cell_width; // what it is seen through, in cells
    sint level;        // of a picture the finer of the two; else 0
    HeightLevel fine, coarse;
    sfloat weight; // of the coarser
};

inline HeightLevel height_level(pointer<TextureRecord> texture, sint level) {
    HeightLevel l;
    l.width = load(field(texture, &TextureRecord::width) + level);
    l.height = load(field(texture, &TextureRecord::height) + level);
    l.first = load(field(texture, &TextureRecord::first) + level);
    return l;
}

inline Displacing displacing_of(const Context& c, const Cage& g, sint face) {
    Displacing d;
    sint material = load(field(c.instances + g.instance, &InstanceRecord::material));
    if (branch(material < 0)) {
        pointer<std::int32_t> of_faces = load(field(c.frame, &FrameHeader::face_materials));
        material = load(of_faces + face);
    }
    pointer<MaterialRecord> materials = load(field(c.frame, &FrameHeader::materials));
    sint number = load(field(materials + material, &MaterialRecord::displacement));
    d.any = number >= 0;
    if (branch(number < 0))
        return d;
    pointer<DisplacementRecord> records = load(field(c.frame, &FrameHeader::displacements));
    d.record = records + number;
    d.scale = load(field(d.record, &DisplacementRecord::scale));
    d.midlevel = load(field(d.record, &DisplacementRecord::midlevel));
    d.bound = load(field(d.record, &DisplacementRecord::bound));
    sint map_number = load(field(d.record, &DisplacementRecord::map));
    pointer<MapRecord> maps = load(field(c.frame, &FrameHeader::maps));
    pointer<MapRecord> map = maps + map_number;
    d.row_u = load_svec(field(map, &MapRecord::row_u));
    d.row_v = load_svec(field(map, &MapRecord::row_v));
    sint texture_number = load(field(map, &MapRecord::texture));
    pointer<TextureRecord> textures = load(field(c.frame, &FrameHeader::textures));
    pointer<TextureRecord> texture = textures + texture_number;
    pointer<std::int32_t> texels = load(field(c.frame, &FrameHeader::texels));
    d.texels = as<float>(texels);
    d.wrap_u = load(field(texture, &TextureRecord::wrap_u));
    d.wrap_v = load(field(texture, &TextureRecord::wrap_v));
    pointer<float> densities = load(field(c.frame, &FrameHeader::texture_densities));
    sfloat density = load(densities + face);
    sfloat edge = load(field(c.instances + g.instance, &InstanceRecord::mesh_edge_length));
    sfloat footprint = load(field(d.record, &DisplacementRecord::footprint));
    sfloat square = density * (edge * edge);
    sfloat covered = min(max(square * footprint, 1.0e-20F), 1.0e20F);
    d.texture = texture;
    d.kind = load(field(texture, &TextureRecord::kind));
    if (branch(d.kind != sint(texture_image))) {
        d.cell_width = sqrt(covered);
        d.level = 0;
        d.weight = 0.0F;
        return d;
    }
    sfloat level = extract(log2(vfloat(covered)), 0) * 0.5F;
    sint levels = load(field(texture, &TextureRecord::levels));
    sfloat last = to_float(levels - 1);
    level = min(max(level, 0.0F), last);
    d.level = to_int(level);
    d.weight = level - to_float(d.level);
    d.fine = height_level(texture, d.level);
    sint above = d.level + 1;
    d.coarse = height_level(texture, min(above, levels - 1));
    return d;
}

inline vfloat heights_in(const Displacing& d, const HeightLevel& level, const vpoint& at, const vmask& m) {
    vint width(level.width);
    vint height(level.height);
    vint first(level.first);
    vint tiles((level.width + 3) >> 2);
    Neighbours x = neighbours_of(at.u, width, d.wrap_u);
    Neighbours y = neighbours_of(vfloat(1.0F) - at.v, height, d.wrap_v); // rows run down
    vint word = texel_word(first, tiles, x.low, y.low);
    vfloat a = gather(d.texels, word, m);
    word = texel_word(first, tiles, x.high, y.low);
    vfloat b = gather(d.texels, word, m);
    vfloat upper = fma(x.weight, b - a, a);
    word = texel_word(first, tiles, x.low, y.high);
    a = gather(d.texels, word, m);
    word = texel_word(first, tiles, x.high, y.high);
    b = gather(d.texels, word, m);
    vfloat lower = fma(x.weight, b - a, a);
    return fma(y.weight, lower - upper, upper);
}

/// A picture's, at coordinates of its map.
inline vfloat picture_height(const Displacing& d, const vfloat& u, const vfloat& v, const vmask& m) {
    vpoint at;
    at.u = wrap_coordinate(u, d.wrap_u);
    at.v = wrap_coordinate(v, d.wrap_v);
    vfloat value = heights_in(d, d.fine, at, m);
    if (branch(d.weight > 0.0F)) {
        vfloat coarse = heights_in(d, d.coarse, at, m);
        vfloat weight(d.weight);
        value = fma(weight, coarse - value, value);
    }
    return value;
}
/// A pattern's: its red.
[[gnu::noinline]] inline vfloat pattern_height(const Displacing& d, const vfloat& u, const vfloat& v) {
    sfloat per_cell = load(field(d.texture, &TextureRecord::per_cell));
    vfloat width(d.cell_width);
    vfloat zero(0.0F);
    vvec q = in_cells({u, v, zero}, per_cell);
    q.z = vfloat(pattern_plane);
    vfloat value = pattern_value(d.texture, d.kind, q, {width, width, zero});
    vfloat low = load_broadcast(field(d.texture, &TextureRecord::low));
    vfloat high = load_broadcast(field(d.texture, &TextureRecord::high));
    return fma(value, high - low, low);
}

/// Of places on a face, one a lane, by their texture coordinates: how far they are displaced, in the mesh's
/// units. All that is known of heights: what makes them in another way belongs here, and says in
/// height_change() how fast they change.
inline vfloat height_at(const Displacing& d, const vpoint& uv, const vmask& m) {
    vfloat across(d.row_u.x);
    vfloat up(d.row_u.y);
    vfloat u = fma(across, uv.u, fma(up, uv.v, vfloat(d.row_u.z)));
    across = vfloat(d.row_v.x);
    up = vfloat(d.row_v.y);
    vfloat v = fma(across, uv.u, fma(up, uv.v, vfloat(d.row_v.z)));
    vfloat value;
    if (branch(d.kind == sint(texture_image)))
        value = picture_height(d, u, v, m);
    else
        value = pattern_height(d, u, v);
    vfloat height = value - vfloat(d.midlevel);
    height = height * vfloat(d.scale);
    height = max(height, vfloat(-d.bound));
    return min(height, vfloat(d.bound));
}

/// By how much heights differ, at most, between places whose texture coordinates differ by no more than du
/// and dv and are none of them larger than `reach`.
inline sfloat height_change(const Displacing& d, sfloat du, sfloat dv, sfloat reach) {
    sint next = min(d.level + 1, 15);
    sfloat fine = load(field(d.record, &DisplacementRecord::slope_u) + d.level);
    sfloat coarse = load(field(d.record, &DisplacementRecord::slope_u) + next);
    sfloat slope_u = max(fine, coarse);
    fine = load(field(d.record, &DisplacementRecord::slope_v) + d.level);
    coarse = load(field(d.record, &DisplacementRecord::slope_v) + next);
    sfloat slope_v = max(fine, coarse);
    auto along = [&](const svec& row) {
        sfloat x = abs(row.x);
        sfloat y = abs(row.y);
        sfloat size = abs(row.z) + 1.0F;
        size = fma(x + y, reach, size);
        sfloat rounding = size * more_roundings;
        return fma(x, du, fma(y, dv, rounding));
    };
    sfloat change = along(d.row_u) * slope_u;
    change = fma(along(d.row_v), slope_v, change);
    return min(change, load(field(d.record, &DisplacementRecord::range)));
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
