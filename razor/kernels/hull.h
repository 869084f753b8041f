// Boxes of patches from their control points, one lane a patch. A limit surface lies in the hull of the
// control points that influence it (subdivision masks are convex). OpenSubdiv's approximation and rounding
// may leave it by a little: a box grows by 1/256 of its size.
#pragma once

#include "razor/kernels/surface.h"

namespace razor::ISA_TARGET {
inline namespace animate_kernel {

inline constexpr float hull_growth = 1.0F / 256.0F;
/// More than rounding moves a point by, relative to the largest number on its way. A sum over n control
/// points has n roundings: of regular faces 16. Where n is more, beside points of high valence, hull_growth
/// is more than the rest unless the box is smaller than 256 n u of its largest coordinate (1/330, where n is
/// 200).
inline constexpr float hull_rounding = few_roundings;

struct Hulls {
    vvec low, high;
    vfloat reach; // largest coordinate of the control points, mesh units
};

/// Hulls of patch records `record`, in mesh coordinates or, where `Moved`, in those of the cage's place.
template <bool Moved>
inline Hulls hulls_of(const Cage& g, pointer<PatchRecord> patches, const vint& record, const vmask& m) {
    constexpr int patch_words = sizeof(PatchRecord) / 4;
    constexpr int face_words = sizeof(FaceRecord) / 4;
    vint face = gather(field(patches, &PatchRecord::face), record * vint(patch_words), m);
    vint face_record = face * vint(face_words);
    vint at = gather(field(g.faces, &FaceRecord::control_first), face_record, m);
    vint left = gather(field(g.faces, &FaceRecord::control_count), face_record, m);
    left = select(m, left, vint(0));
    vfloat big(3.0e38F);
    vfloat small(-3.0e38F);
    Hulls h;
    h.low = {big, big, big};
    h.high = {small, small, small};
    h.reach = vfloat(0.0F);
    for (vmask more = left > vint(0); branch(any(more)); more = left > vint(0)) {
        vint point = gather(g.controls, at, more);
        vint word = point * vint(3);
        vfloat x = gather(g.points, word, more);
        vfloat y = gather(g.points + 1, word, more);
        vfloat z = gather(g.points + 2, word, more);
        vvec p{x, y, z};
        vfloat size = largest(abs(p));
        h.reach = max(select(more, size, vfloat(0.0F)), h.reach);
        if constexpr (Moved)
            p = moved_points(g.place, p);
        vvec lower{min(p.x, h.low.x), min(p.y, h.low.y), min(p.z, h.low.z)};
        vvec upper{max(p.x, h.high.x), max(p.y, h.high.y), max(p.z, h.high.z)};
        h.low = select(more, lower, h.low);
        h.high = select(more, upper, h.high);
        at = at + vint(1);
        left = left - vint(1);
    }
    return h;
}

} // namespace animate_kernel
} // namespace razor::ISA_TARGET
