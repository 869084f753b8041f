// Refitting: the box of every patch, from its control points, by all workers together. One lane a patch.
// A limit surface lies in the hull of the control points that influence it (subdivision masks are convex).
// OpenSubdiv's approximation and rounding may leave it by a little: the box grows by 1/256 of its size.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace animate_kernel {

inline constexpr float hull_growth = 1.0F / 256.0F;

inline void refit_chunk(const Context& c, sint first) {
    sint patches = load(field(c.frame, &FrameHeader::patch_count));
    sint stride = load(field(c.frame, &FrameHeader::bounds_stride));
    pointer<float> bounds = load(field(c.frame, &FrameHeader::bounds));
    pointer<FaceRecord> faces = load(field(c.frame, &FrameHeader::faces));
    pointer<std::int32_t> controls = load(field(c.frame, &FrameHeader::controls));
    pointer<float> points = load(field(c.frame, &FrameHeader::points));
    constexpr int patch_words = sizeof(PatchRecord) / 4;
    constexpr int face_words = sizeof(FaceRecord) / 4;
    constexpr int mesh_words = sizeof(MeshRecord) / 4;
    for (sint from = first; branch(from < min(first + refit_patches, patches)); from += isa::width) {
        vmask m = first_lanes(patches - from);
        vint patch = lane_index() + vint(from);
        vint record = patch * vint(patch_words);
        vint face = gather(field(c.patches, &PatchRecord::face), record, m);
        vint mesh = gather(field(c.patches, &PatchRecord::mesh), record, m);
        vint face_record = face * vint(face_words);
        vint at = gather(field(faces, &FaceRecord::control_first), face_record, m);
        vint left = gather(field(faces, &FaceRecord::control_count), face_record, m);
        left = select(m, left, vint(0));
        vfloat big(3.0e38F);
        vfloat small(-3.0e38F);
        vvec lo{big, big, big};
        vvec hi{small, small, small};
        for (vmask more = left > vint(0); branch(any(more)); more = left > vint(0)) {
            vint point = gather(controls, at, more);
            vint word = point * vint(3);
            vfloat x = gather(points, word, more);
            vfloat y = gather(points + 1, word, more);
            vfloat z = gather(points + 2, word, more);
            vvec p{x, y, z};
            vvec lower{min(p.x, lo.x), min(p.y, lo.y), min(p.z, lo.z)};
            vvec upper{max(p.x, hi.x), max(p.y, hi.y), max(p.z, hi.z)};
            lo = select(more, lower, lo);
            hi = select(more, upper, hi);
            at = at + vint(1);
            left = left - vint(1);
        }
        vint origin = mesh * vint(mesh_words);
        vfloat size = largest(hi - lo);
        vfloat grow = size * hull_growth;
        vfloat low[3] = {lo.x, lo.y, lo.z};
        vfloat high[3] = {hi.x, hi.y, hi.z};
        for (int k = 0; k < 3; ++k) {
            vfloat low_size = abs(low[k]);
            vfloat high_size = abs(high[k]);
            vfloat o = gather(field(c.meshes, &MeshRecord::origin) + k, origin, m);
            vfloat reach = max(low_size, max(high_size, abs(o)));
            vfloat slack = fma(reach, vfloat(4.0e-7F), grow); // rounding of the additions below
            vfloat a = (low[k] - slack) + o;
            vfloat b = (high[k] + slack) + o;
            pointer<float> out = bounds + stride * k + from;
            store_vector(out, a, m);
            store_vector(out + stride * 3, b, m);
        }
    }
}

/// Refits every patch once, whoever takes part; returns when all are done.
[[gnu::noinline]] inline void refit(const Context& c) {
    phase_scope phase(phase_animate);
    pointer<QueueRecord> queues = load(field(c.frame, &FrameHeader::queues));
    sint chunks = load(field(c.frame, &FrameHeader::refit_chunks));
    sint chunk = fetch_add(field(queues, &QueueRecord::next_refit), 1);
    while (branch(chunk < chunks)) {
        refit_chunk(c, chunk * refit_patches);
        fetch_add(field(queues, &QueueRecord::refitted), 1);
        chunk = fetch_add(field(queues, &QueueRecord::next_refit), 1);
    }
    sint done = load_acquire(field(queues, &QueueRecord::refitted));
    while (branch(done != chunks))
        done = wait_while(field(queues, &QueueRecord::refitted), done);
}

} // namespace animate_kernel
} // namespace razor::ISA_TARGET
