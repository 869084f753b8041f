// Textures that are functions, as hits see them: of texture coordinates, or of points of the object.
#pragma once

#include "razor/kernels/mapping.h"
#include "razor/kernels/pattern_value.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// The pattern's colour at points of a material's map.
[[gnu::noinline]] inline vvec sample_pattern(pointer<MapRecord> map, pointer<TextureRecord> t,
                                             const Mapping& hit) {
    sfloat per_cell = load(field(t, &TextureRecord::per_cell));
    sint space = load(field(t, &TextureRecord::space));
    vvec q, width;
    vfloat zero(0.0F);
    if (branch(space == texture_of_object)) {
        q = hit.solid;
        vfloat wide = sqrt(hit.solid_area);
        wide = wide * vfloat(per_cell);
        width = hit.solid_spread * wide;
    } else {
        vvec row_u = load_broadcast_vec(field(map, &MapRecord::row_u));
        vvec row_v = load_broadcast_vec(field(map, &MapRecord::row_v));
        q.x = fma(row_u.x, hit.at.u, fma(row_u.y, hit.at.v, row_u.z));
        q.y = fma(row_v.x, hit.at.u, fma(row_v.y, hit.at.v, row_v.z));
        q.z = zero;
        vfloat scale = abs(fms(row_u.x, row_v.y, row_u.y * row_v.x));
        vfloat wide = sqrt(hit.footprint * scale);
        wide = wide * vfloat(per_cell);
        width = {wide, wide, zero};
    }
    q = in_cells(q, per_cell);
    sint kind = load(field(t, &TextureRecord::kind));
    if (branch(space != texture_of_object))
        q.z = vfloat(pattern_plane);
    vfloat value = pattern_value(t, kind, q, width);
    vvec low = load_broadcast_vec(field(t, &TextureRecord::low));
    vvec high = load_broadcast_vec(field(t, &TextureRecord::high));
    return madd(value, high - low, low);
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
