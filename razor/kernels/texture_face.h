// A face in its mesh's texture cage (razor/surface/texture_cage.h).
#pragma once

#include "razor/kernels/cage.h"

namespace razor::ISA_TARGET {

struct spoint {
    sfloat u, v;
};
inline spoint operator+(const spoint& a, const spoint& b) {
    return {a.u + b.u, a.v + b.v};
}

/// The face's record in the texture cage, whose corners are its controls.
struct TextureFace {
    pointer<FaceRecord> record;
    sint first, corners;
};

/// At corner `k` of the face, from 0 to twice the number of corners.
inline spoint corner_texcoord(const Cage& g, const TextureFace& face, sint k) {
    sint n = face.corners;
    sint around = k - n;
    sint corner = select(around >= 0, around, k);
    sint point = load(g.controls + (face.first + corner));
    spoint p;
    p.u = load(g.points + point * 3);
    p.v = load(g.points + (point * 3 + 1));
    return p;
}
inline spoint middle(const spoint& a, const spoint& b) {
    spoint sum = a + b;
    return {sum.u * 0.5F, sum.v * 0.5F};
}

/// `shift`: from the mesh's faces to those of its texture cage.
inline TextureFace texture_face(const Cage& g, sint number, sint shift) {
    TextureFace face;
    face.record = g.faces + (number + shift);
    face.first = load(field(face.record, &FaceRecord::control_first));
    face.corners = load(field(face.record, &FaceRecord::corner_count));
    return face;
}

/// The mean of a face's corners.
inline spoint mean_texcoord(const Cage& g, const TextureFace& face) {
    spoint sum{sfloat(0.0F), sfloat(0.0F)};
    for (sint i = 0; branch(i < face.corners); ++i)
        sum = sum + corner_texcoord(g, face, i);
    sfloat share = sfloat(1.0F) / to_float(face.corners);
    return {sum.u * share, sum.v * share};
}

} // namespace razor::ISA_TARGET
