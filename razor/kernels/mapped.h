// Members of hits' materials, and what maps make of them.
#pragma once

#include "razor/kernels/texture.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Members of the materials of a packet's hits.
struct Materials {
    pointer<MaterialRecord> first;
    vint record; // words from there
    vmask present;

    vfloat number(float MaterialRecord::*member) const {
        return gather(field(first, member), record, present);
    }
    vvec colour(float (MaterialRecord::*member)[3]) const {
        return gather_vec(field(first, member), record, vint(1), present);
    }
    vvec mapped(const Context& c, MaterialMap which, const Mapping& hit) const {
        vint map = gather(field(first, &MaterialRecord::map) + which, record, present);
        return mapped_colour(c, map, hit, present);
    }
};
inline Materials materials_of(const Context& c, const Beyond& b, const vmask& hit) {
    pointer<MaterialRecord> first = load(field(c.frame, &FrameHeader::materials));
    return {first, b.material * vint(material_stride), hit};
}

inline vvec times(const vvec& a, const vvec& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Shading normals bent by normal maps, which hold what they are against tangents along u and v and the
/// normal.
inline void bend_normals(const Context& c, const Beyond& b, Surface& s) {
    Materials of = materials_of(c, b, s.hit);
    vint map = gather(field(of.first, &MaterialRecord::map) + map_normal, of.record, s.hit);
    vmask has = s.hit & (map >= vint(0));
    if (branch(none(has)))
        return;
    vvec colour = mapped_colour(c, map, b.map, has);
    vfloat scale = of.number(&MaterialRecord::normal_scale);
    vfloat x = fma(colour.x, vfloat(2.0F), vfloat(-1.0F)) * scale;
    vfloat y = fma(colour.y, vfloat(2.0F), vfloat(-1.0F)) * scale;
    vfloat z = fma(colour.z, vfloat(2.0F), vfloat(-1.0F));
    vvec own = s.shading * b.side; // as the surface has it
    vvec along = b.map.along_u - own * dot(own, b.map.along_u);
    vfloat zero(0.0F);
    vvec tangent = normalise(along, {zero, zero, zero});
    vvec bitangent = cross(own, tangent);
    vfloat turned = dot(bitangent, b.map.along_v);
    bitangent = bitangent * select(turned < zero, vfloat(-1.0F), vfloat(1.0F));
    vvec bent = madd(y, bitangent, tangent * x);
    bent = madd(z, own, bent) * b.side;
    s.shading = select(has, normalise(bent, s.shading), s.shading);
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
