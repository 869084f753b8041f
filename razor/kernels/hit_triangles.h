// The triangles that rays hit, as these see them.
#pragma once

#include "razor/kernels/shading_grid.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// The three vertices of the triangles hit, from component arrays at word `base` of each lane's block.
struct TriangleWords {
    vint a, b, c; // of x; y and z follow at +stride, +2 stride
    vint stride;
};

/// Word numbers, from the grids' base, of the vertices of the triangles hit.
inline TriangleWords locate(const Context& c, const Hits& h, const vmask& m) {
    pointer<std::int32_t> words = as<std::int32_t>(c.grids);
    vint block = h.block << 4;
    constexpr int quads_u_word = offsetof(BlockHeader, quads_u) / 4;
    constexpr int stride_word = offsetof(BlockHeader, stride) / 4;
    vint quads_u = gather(words + quads_u_word, block, m);
    TriangleWords t;
    t.stride = gather(words + stride_word, block, m);
    vint which = h.triangle & vint(1);
    vint quad = (h.triangle >> 1) & vint(63);
    vint row = quad >> block_log2;
    vint column = quad & vint(block_quads - 1);
    vint width = quads_u + vint(1);
    vint low = row * width + column;
    low = low + block;
    vint high = low + width;
    vmask second = which > vint(0);
    t.a = low;
    vint right = low + vint(1);
    vint opposite = high + vint(1);
    t.b = select(second, opposite, right);
    t.c = select(second, high, opposite);
    return t;
}

/// Arrays of one number a vertex, blended as normals are, by the same weights: what lies at the corners.
inline void copy_corners(pointer<float> own, sint quads_u, sint quads_v, sint stride, sint arrays,
                         pointer<float> out) {
    for (sint a = 0; branch(a < arrays); ++a) {
        for (int k = 0; k < 4; ++k) {
            sint vertex = corner_vertex(k, quads_u, quads_v);
            sfloat value = load(own + vertex);
            store(out + vertex, value);
        }
        own = own + stride;
        out = out + stride;
    }
}
/// Of one pass' vertices.
inline void blend_arrays(pointer<float> own, const BlendStep& s, const vfloat& weight, sint stride,
                         sint arrays, pointer<float> out, const vmask& m) {
    for (sint a = 0; branch(a < arrays); ++a) {
        vfloat at = gather(own, s.vertex, m);
        vfloat one = gather(out, s.one, m);
        vfloat other = gather(out, s.other, m);
        vfloat mean = (one + other) * 0.5F;
        scatter(out, s.vertex, fma(weight, at - mean, mean), m);
        own = own + stride;
        out = out + stride;
    }
}

/// What lies on vertices beside normals: where in the block, where in a slot, and how many arrays.
struct Attribute {
    pointer<float> own, out;
    sint arrays = 0;
};
/// Texture coordinates; places at rest; and what is shaded, which is there once this returns, if the camera's
/// field is the slot's.
inline void find_attributes(const Context& c, pointer<BlockHeader> block, pointer<float> normals,
                            pointer<float> slot, Attribute (&found)[3]) {
    sint instance = load(field(block, &BlockHeader::instance));
    sint shading = load(field(c.instances + instance, &InstanceRecord::shading));
    sint stride = load(field(block, &BlockHeader::stride));
    found[0] = {normals + stride * 3, slot + slot_texcoords, texcoord_arrays(shading)};
    sint number = load(as<std::int32_t>(slot) + slot_field);
    sbool shaded = shaded_bits(shading) != 0;
    shaded = shaded & (number == camera_number);
    if (branch(shaded))
        found[1] = {ensure_shaded(c, block, normals, shading), slot + slot_shaded, shaded_arrays_in(shading)};
    found[2] = {rest_at(normals, stride, shading), slot + slot_rest(shading), rest_arrays(shading)};
}

/// Blends the normals of the block whose vertices lie blended in a slot, with the same weights, beside them;
/// Mapped: also texture coordinates, places at rest and what is shaded.
template <bool Mapped>
inline void blend_normals(const Context& c, sint line, pointer<float> normals, pointer<float> slot) {
    pointer<float> area = slot + slot_block;
    pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    sint stride = load(field(block, &BlockHeader::stride));
    pointer<float> x = area + blend_normals_at;
    pointer<float> weights = area + blend_weights;
    for (int k = 0; k < 4; ++k) {
        sint vertex = corner_vertex(k, quads_u, quads_v);
        svec n = load_vertex(normals, stride, vertex);
        store(x + vertex, n.x);
        store(x + stride + vertex, n.y);
        store(x + stride * 2 + vertex, n.z);
    }
    Attribute attribute[3];
    if constexpr (Mapped) {
        find_attributes(c, block, normals, slot, attribute);
        for (const Attribute& a : attribute)
            copy_corners(a.own, quads_u, quads_v, stride, a.arrays, a.out);
    }
    pointer<std::int32_t> pass = blend_table(c, quads_u, quads_v);
    for (int p = 0; p < blend_passes; ++p) {
        sint n = load(pass);
        for (sint from = 0; branch(from < n); from += isa::width) {
            vmask m = first_lanes(n - from);
            BlendStep s = load_step(pass, from, m);
            vvec own = gather_vertex(normals, stride, s.vertex, m);
            vvec one = gather_vertex(x, stride, s.one, m);
            vvec other = gather_vertex(x, stride, s.other, m);
            vfloat weight = gather(weights, s.vertex, m);
            vvec q = blend_vertex(weight, own, one, other);
            scatter_vec(x, stride, s.vertex, q, m);
            if constexpr (Mapped) {
                for (const Attribute& a : attribute)
                    blend_arrays(a.own, s, weight, stride, a.arrays, a.out, m);
            }
        }
        pass = pass + pass_words;
    }
}

/// Returns them, once they are there.
template <bool Mapped>
inline pointer<float> blended_normals(const Context& c, sint line, pointer<float> normals,
                                      pointer<float> slot) {
    build_once(c, as<shared_int>(slot) + slot_normals,
               [&] { blend_normals<Mapped>(c, line, normals, slot); });
    return slot + (slot_block + blend_normals_at);
}

/// The slot that holds the block as the field of that lane sees it.
inline pointer<float> blended_slot(const Context& c, sint lane, sint line) {
    sint number = load(as<std::int32_t>(c.packets + packet_number) + lane);
    Kept kept = find_blended(c, number, line, no_leaf);
    if (branch(!kept.there)) {
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + line);
        sint instance = load(field(block, &BlockHeader::instance));
        svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
        blend_block(c, field_of(c, lane, origin), number, line, no_leaf, kept.slot);
    }
    return kept.slot;
}

/// A block between two levels of the paper's scheme, `number` that of the finer one's field: arrays of both
/// levels' vertices, and of their normals.
struct BlockPair {
    pointer<float> fine, coarse, fine_normals, coarse_normals;
};
template <bool Mapped>
inline BlockPair block_pair(const Context& c, sint line, sint number, sint normals_at) {
    sint level = level_of_number(number);
    pointer<float> fine = level_slot(c, level, line);
    pointer<float> coarse = level_slot(c, level + 1, line);
    BlockPair p;
    p.fine = fine + (slot_block + block_header_words);
    p.coarse = coarse + (slot_block + block_header_words);
    if (branch(normals_at != 0)) {
        pointer<float> normals = as<float>(c.grids + line) + normals_at;
        p.fine_normals = blended_normals<Mapped>(c, line, normals, fine);
        p.coarse_normals = blended_normals<Mapped>(c, line, normals, coarse);
    }
    return p;
}

/// The vertex and its normal where each ray sees them.
inline void find_between(const BlockPair& p, const Scale& s, const vvec& from, sint number, const vint& at,
                         const vint& stride, sint normals_at, const vmask& m, vvec& vertex, vvec& normal) {
    vvec fine = gather_vec(p.fine, at, stride, m);
    vvec coarse = gather_vec(p.coarse, at, stride, m);
    sint level = level_of_number(number);
    vfloat weight = pair_weight(s, dot(fine - from, s.direction), level);
    vertex = select(m, blend_pair(weight, fine, coarse), vertex);
    if (branch(normals_at != 0)) {
        fine = gather_vec(p.fine_normals, at, stride, m);
        coarse = gather_vec(p.coarse_normals, at, stride, m);
        normal = select(m, blend_pair(weight, fine, coarse), normal);
    }
}

/// Texture coordinates of a corner of the triangles hit, `texcoords` being those of the block, u[stride],
/// v[stride].
inline void gather_texcoord(pointer<float> texcoords, const vint& corner, const vint& stride,
                            const vmask& here, vpoint& at) {
    vfloat u = gather(texcoords, corner, here);
    vfloat v = gather(texcoords, corner + stride, here);
    at.u = select(here, u, at.u);
    at.v = select(here, v, at.v);
}

/// Block after block. `known`: what textures make of the triangles, where that is shaded at vertices, if
/// `on_grids`; Mapped only.
template <bool Mapped, bool Glossy>
inline Corners find_triangles(const Context& c, const Rays& r, const Hits& h, const vmask& hit,
                              sbool on_grids, Shaded& known) {
    TriangleWords t = locate(c, h, hit);
    vfloat zero(0.0F);
    vvec none_yet{zero, zero, zero};
    Corners k;
    k.a = k.b = k.c = k.at_a = k.at_b = k.at_c = k.normal = none_yet;
    k.sway = k.sway_above = zero;
    k.chord_normal = none_yet;
    k.chord_slope = zero;
    k.chord_most = vfloat(infinite);
    k.has_chords = vmask(false);
    if constexpr (Mapped) {
        k.map_a = k.map_b = k.map_c = {zero, zero};
        k.rest_a = k.rest_b = k.rest_c = none_yet;
        k.has_rest = vmask(false);
        known = nothing_shaded();
    }
    vint first_word = h.block << 4;
    HitCorners at;
    at.a = t.a - first_word;
    at.b = t.b - first_word;
    at.c = t.c - first_word;
    for (vmask left = hit; branch(any(left));) {
        sint one = first(left);
        sint block = extract(h.block, one);
        sint lane = extract(h.field, one);
        vmask here = left & (h.block == vint(block));
        here = here & (h.field == vint(lane));
        left = left & !here;
        pointer<float> words = as<float>(c.grids + block);
        pointer<BlockHeader> header = as<BlockHeader>(words);
        sint corners_at = load(field(header, &BlockHeader::corners_at));
        if (branch(corners_at != no_vertex_moves)) {
            pointer<float> sways = field(header, &BlockHeader::sway);
            k.sway = select(here, load_broadcast(sways), k.sway);
            if constexpr (Glossy)
                k.sway_above = select(here, load_broadcast(sways + 1), k.sway_above);
        }
        sint normals_at = ensure_normals(c, block);
        if (branch(normals_at != 0)) {
            k.has_chords = k.has_chords | here;
            pointer<float> chords = chords_at(header, normals_at);
            k.chord_normal = select(here, load_broadcast_vec(chords + int{chord_normal}), k.chord_normal);
            k.chord_slope = select(here, load_broadcast(chords + int{chord_slope}), k.chord_slope);
            k.chord_most = select(here, load_broadcast(chords + int{chord_most}), k.chord_most);
        }
        pointer<float> vertices = words + block_header_words;
        pointer<float> normals = words + normals_at;
        [[maybe_unused]] sint shading = 0;
        [[maybe_unused]] sint stride = 0;
        [[maybe_unused]] sbool on_grid = false;
        if constexpr (Mapped) {
            sint instance = load(field(header, &BlockHeader::instance));
            shading = load(field(c.instances + instance, &InstanceRecord::shading));
            stride = load(field(header, &BlockHeader::stride));
            if (branch(on_grids))
                on_grid = has_shaded_grid(c, header, shading);
        }
        [[maybe_unused]] const auto find_texcoords = [&](pointer<float> texcoords) {
            if (branch(texcoord_arrays(shading) != 0)) {
                gather_texcoord(texcoords, at.a, t.stride, here, k.map_a);
                gather_texcoord(texcoords, at.b, t.stride, here, k.map_b);
                gather_texcoord(texcoords, at.c, t.stride, here, k.map_c);
            }
        };
        [[maybe_unused]] const auto find_rest = [&](pointer<float> rest) {
            if (branch(rest_arrays(shading) != 0)) {
                k.has_rest = k.has_rest | here;
                k.rest_a = select(here, gather_vec(rest, at.a, t.stride, here), k.rest_a);
                k.rest_b = select(here, gather_vec(rest, at.b, t.stride, here), k.rest_b);
                k.rest_c = select(here, gather_vec(rest, at.c, t.stride, here), k.rest_c);
            }
        };
        if (branch(lane < -1)) {
            BlockPair p = block_pair<Mapped>(c, block, lane, normals_at);
            Scale scale = scale_of(c, r);
            sint instance = load(field(header, &BlockHeader::instance));
            svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
            vvec from = r.origin - broadcast(origin);
            find_between(p, scale, from, lane, at.a, t.stride, normals_at, here, k.a, k.at_a);
            find_between(p, scale, from, lane, at.b, t.stride, normals_at, here, k.b, k.at_b);
            find_between(p, scale, from, lane, at.c, t.stride, normals_at, here, k.c, k.at_c);
            k.normal = select(here, blend(k.at_a, k.at_b, k.at_c, h), k.normal);
            if constexpr (Mapped) { // as they are at the anchors
                find_texcoords(normals + stride * 3);
                find_rest(rest_at(normals, stride, shading));
                if (branch(on_grid)) {
                    pointer<float> shaded = ensure_shaded(c, header, normals, shading);
                    find_shaded(shaded, stride, shading, h, at, here, known);
                }
            }
            continue;
        }
        [[maybe_unused]] pointer<float> texcoords = normals;
        [[maybe_unused]] pointer<float> rest = normals;
        [[maybe_unused]] pointer<float> shaded = normals;
        if constexpr (Mapped) {
            texcoords = normals + stride * 3;
            rest = rest_at(normals, stride, shading);
        }
        if (branch(lane >= 0)) {
            pointer<float> slot = blended_slot(c, lane, block);
            vertices = slot + (slot_block + block_header_words);
            if (branch(normals_at != 0))
                normals = blended_normals<Mapped>(c, block, normals, slot);
            texcoords = slot + slot_texcoords;
            rest = slot + slot_rest(shading);
            shaded = slot + slot_shaded;
        } else if constexpr (Mapped) {
            if (branch(on_grid))
                shaded = ensure_shaded(c, header, normals, shading);
        }
        if constexpr (Mapped) {
            find_texcoords(texcoords);
            find_rest(rest);
            if (branch(on_grid))
                find_shaded(shaded, stride, shading, h, at, here, known);
        }
        vvec a = gather_vec(vertices, at.a, t.stride, here);
        vvec b = gather_vec(vertices, at.b, t.stride, here);
        vvec d = gather_vec(vertices, at.c, t.stride, here);
        k.a = select(here, a, k.a);
        k.b = select(here, b, k.b);
        k.c = select(here, d, k.c);
        if (branch(normals_at != 0)) {
            vvec na = gather_vec(normals, at.a, t.stride, here);
            vvec nb = gather_vec(normals, at.b, t.stride, here);
            vvec nc = gather_vec(normals, at.c, t.stride, here);
            k.at_a = select(here, na, k.at_a);
            k.at_b = select(here, nb, k.at_b);
            k.at_c = select(here, nc, k.at_c);
            k.normal = select(here, blend(na, nb, nc, h), k.normal);
        }
    }
    return k;
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
