// Phase one of shading: what textures make of a surface at the vertices of its blocks, found once, when the
// first camera ray is shaded there, for the area that rays of the camera ask for at each vertex. That depends
// on where the vertex lies and not on the block, so blocks of two levels agree at the vertices that they
// share; between these the values are blended as the vertices themselves are, so that nothing jumps where
// levels change (Stoll et al. 2006 shade grids so; that values do not depend on the level is ours).
#pragma once

#include "razor/kernels/mapped.h"
#include "razor/kernels/normals.h"

namespace razor::ISA_TARGET {
inline namespace shade_kernel {

/// Of a block's edge length: for what rays ask for from so much on, values at its vertices serve alone, and
/// up to so much not at all. Levels are chosen so that edges are at most sqrt(2) times as long as asked for.
inline constexpr float shaded_edge = 0.7F, least_shaded_edge = 0.35F;

/// Whether something is shaded at the vertices of this block.
inline sbool has_shaded_grid(const Context& c, pointer<BlockHeader> block, sint shading) {
    if (branch(shaded_bits(shading) == 0))
        return false;
    sint patch = load(field(block, &BlockHeader::patch));
    sint instance = load(field(block, &BlockHeader::instance));
    sint kind = load(field(patch_record(c, instance, patch), &PatchRecord::kind));
    return kind < static_cast<int>(PatchKind::flat_quad);
}

/// The arrays of what is shaded, `normals` being those of the block: static ones, and the state behind them.
inline pointer<float> shaded_at(pointer<float> normals, sint stride, sint shading) {
    sint before = texcoord_arrays(shading) + 3;
    before = before + rest_arrays(shading);
    return normals + before * stride;
}

/// What the surface's material is: its number.
inline sint material_of_patch(const Context& c, sint instance, sint patch) {
    sint material = load(field(c.instances + instance, &InstanceRecord::material));
    if (branch(material < 0)) {
        sint face = load(field(patch_record(c, instance, patch), &PatchRecord::face));
        pointer<std::int32_t> of_faces = load(field(c.frame, &FrameHeader::face_materials));
        material = load(of_faces + face);
    }
    return material;
}

/// Some vertices of a block, one a lane, and those beside each along u and v.
struct GridPoints {
    vint at, beside, above;
};
inline GridPoints grid_points(pointer<BlockHeader> block, sint from) {
    sint quads_u = load(field(block, &BlockHeader::quads_u));
    sint quads_v = load(field(block, &BlockHeader::quads_v));
    GridPoints p;
    p.at = lane_index() + vint(from);
    vint column, row;
    vertex_place(quads_u, p.at, column, row);
    vint one(1);
    p.beside = p.at + select(column < vint(quads_u), one, vint(-1));
    vint width = vint(quads_u + 1);
    vint down = vint(0) - width;
    p.above = p.at + select(row < vint(quads_v), width, down);
    return p;
}

/// The triangles that vertices make with those beside them, as if rays had hit them there.
inline Corners grid_corners(pointer<float> vertices, pointer<float> normals, sint stride, sint shading,
                            const GridPoints& p, const vmask& m) {
    sint texcoords = texcoord_arrays(shading);
    Corners k;
    k.a = gather_vertex(vertices, stride, p.at, m);
    k.b = gather_vertex(vertices, stride, p.beside, m);
    k.c = gather_vertex(vertices, stride, p.above, m);
    k.normal = gather_vertex(normals, stride, p.at, m);
    vfloat zero(0.0F);
    k.map_a = k.map_b = k.map_c = {zero, zero};
    if (branch(texcoords != 0)) {
        pointer<float> u = normals + stride * 3;
        pointer<float> v = u + stride;
        k.map_a = {gather(u, p.at, m), gather(v, p.at, m)};
        k.map_b = {gather(u, p.beside, m), gather(v, p.beside, m)};
        k.map_c = {gather(u, p.above, m), gather(v, p.above, m)};
    }
    k.has_rest = vmask(false);
    if (branch(rest_arrays(shading) != 0)) {
        pointer<float> rest = rest_at(normals, stride, shading);
        k.has_rest = m;
        k.rest_a = gather_vertex(rest, stride, p.at, m);
        k.rest_b = gather_vertex(rest, stride, p.beside, m);
        k.rest_c = gather_vertex(rest, stride, p.above, m);
    }
    return k;
}

/// Where vertices lie on textures, as finely as rays of the camera see them there. `p`: scene coordinates.
inline Mapping map_vertices(const Context& c, const Corners& k, const vvec& p, sint absolute) {
    Rays camera;
    ask_for_camera(c, camera);
    vvec way = p - camera.field_origin;
    vfloat target = filtered_target(c, asked_at(camera, way), way);
    sfloat edge = power_of_two(absolute) * shaded_edge;
    target = max(target, vfloat(edge)); // nothing finer than the block can show
    vvec toward = load_broadcast_vec(field(c.frame, &FrameHeader::line_of_sight)) * vfloat(-1.0F);
    sint orthographic = load(field(c.frame, &FrameHeader::orthographic));
    if (branch(orthographic == 0))
        toward = normalise(load_broadcast_vec(field(c.frame, &FrameHeader::camera)) - p, toward);
    vvec edge1 = k.b - k.a;
    vvec edge2 = k.c - k.a;
    vvec area = cross(edge1, edge2);
    vfloat cosine = abs(dot(k.normal, toward));
    Hits corner;
    corner.u = corner.v = vfloat(0.0F);
    return map_hit(k, corner, edge1, edge2, area, target, cosine);
}

/// Which array follows.
inline pointer<float> store_shaded(pointer<float> out, sint stride, sint from, const vvec& v,
                                   const vmask& m) {
    store_vector(out + from, v.x, m);
    out = out + stride;
    store_vector(out + from, v.y, m);
    out = out + stride;
    store_vector(out + from, v.z, m);
    return out + stride;
}

/// What maps make of sheen at some vertices, into the arrays behind all others.
[[gnu::noinline]] inline void shade_sheen(const Context& c, const Materials& of, const Mapping& at, sint bits,
                                          sint stride, sint from, const vmask& m, pointer<float> to) {
    Sheens sheens = sheens_of(c, of);
    Shaded unknown = nothing_shaded();
    if (branch((bits & map_bit(map_sheen)) != 0))
        to = store_shaded(to, stride, from, mapped_sheen(c, sheens, at, unknown), m);
    if (branch((bits & map_bit(map_sheen_roughness)) != 0)) {
        vfloat roughness = mapped_sheen_roughness(c, sheens, at, unknown);
        store_vector(to + from, roughness, m);
    }
}

[[gnu::noinline]] inline void shade_vertices(const Context& c, pointer<BlockHeader> block,
                                             pointer<float> normals, sint shading, pointer<float> out) {
    phase_scope phase(phase_shade);
    sint stride = load(field(block, &BlockHeader::stride));
    sint instance = load(field(block, &BlockHeader::instance));
    sint patch = load(field(block, &BlockHeader::patch));
    sint material = material_of_patch(c, instance, patch);
    sint bits = shaded_bits(shading);
    sint absolute = load(field(block, &BlockHeader::absolute));
    sint moved = load(field(c.instances + instance, &InstanceRecord::moved));
    vfloat side = vfloat(select(moved < 0, sfloat(-1.0F), sfloat(1.0F)));
    vvec origin = load_broadcast_vec(field(c.instances + instance, &InstanceRecord::origin));
    pointer<float> vertices = as<float>(block) + block_header_words;
    Shaded unknown = nothing_shaded();
    for (sint from = 0; branch(from < stride); from += isa::width) {
        vmask m = first_lanes(stride - from);
        GridPoints points = grid_points(block, from);
        Corners k = grid_corners(vertices, normals, stride, shading, points, m);
        Mapping at = map_vertices(c, k, k.a + origin, absolute);
        vvec beside = k.b - k.a;
        vvec above = k.c - k.a;
        Hits vertex;
        vertex.u = vertex.v = vfloat(0.0F);
        map_solid(c, vint(instance << 5), k, vertex, k.a, beside, above, m, at);
        Materials of = materials_of(c, vint(material), m);
        tally(c.counters->shading_evaluations, count(m));
        tally(c.counters->grid_evaluations, count(m));
        tally(c.counters->grid_lanes, sint(isa::width));
        pointer<float> to = out;
        if (branch((bits & map_bit(map_albedo)) != 0)) {
            vvec albedo = mapped_colour_of(c, of, &MaterialRecord::albedo, map_albedo, at, unknown);
            to = store_shaded(to, stride, from, albedo, m);
        }
        if (branch((bits & map_bit(map_metallic)) != 0)) {
            vfloat metallic = mapped_metallic(c, of, at, unknown);
            store_vector(to + from, metallic, m);
            to = to + stride;
        }
        if (branch((bits & map_bit(map_roughness)) != 0)) {
            vfloat roughness = mapped_roughness(c, of, at, unknown);
            store_vector(to + from, roughness, m);
            to = to + stride;
        }
        if (branch((bits & map_bit(map_emission)) != 0)) {
            vvec emission = mapped_colour_of(c, of, &MaterialRecord::emission, map_emission, at, unknown);
            to = store_shaded(to, stride, from, emission, m);
        }
        if (branch((bits & map_bit(map_normal)) != 0)) {
            vvec bent = mapped_normal(c, of, at, k.normal * side, m) * side;
            to = store_shaded(to, stride, from, bent, m);
        }
        if (branch((bits & sheen_bits) != 0))
            shade_sheen(c, of, at, bits, stride, from, m, to);
    }
}

/// Returns the arrays of what is shaded at the block's vertices, once they are there. `normals`: those of the
/// block, which are there.
inline pointer<float> ensure_shaded(const Context& c, pointer<BlockHeader> block, pointer<float> normals,
                                    sint shading) {
    sint stride = load(field(block, &BlockHeader::stride));
    pointer<float> out = shaded_at(normals, stride, shading);
    pointer<float> behind = out + shaded_arrays_in(shading) * stride;
    build_once(c, as<shared_int>(behind), [&] { shade_vertices(c, block, normals, shading, out); });
    return out;
}

/// Between the values at the corners of the triangles hit.
inline vfloat between_corners(pointer<float> values, const Hits& h, const vint& a, const vint& b,
                              const vint& d, const vmask& m) {
    vfloat rest = vfloat(1.0F) - h.u;
    rest = rest - h.v;
    vfloat of_a = gather(values, a, m);
    vfloat of_b = gather(values, b, m);
    vfloat of_c = gather(values, d, m);
    return fma(h.v, of_c, fma(h.u, of_b, of_a * rest));
}
struct HitCorners {
    vint a, b, c; // vertices of the triangles hit
};
inline pointer<float> shaded_vec(pointer<float> values, sint stride, const Hits& h, const HitCorners& at,
                                 const vmask& m, vvec& out) {
    vfloat x = between_corners(values, h, at.a, at.b, at.c, m);
    values = values + stride;
    vfloat y = between_corners(values, h, at.a, at.b, at.c, m);
    values = values + stride;
    vfloat z = between_corners(values, h, at.a, at.b, at.c, m);
    out = select(m, {x, y, z}, out);
    return values + stride;
}

/// Of sheen, from the arrays behind all others.
[[gnu::noinline]] inline void find_shaded_sheen(pointer<float> values, sint stride, sint bits, const Hits& h,
                                                const HitCorners& at, const vmask& m, Shaded& out) {
    if (branch((bits & map_bit(map_sheen)) != 0))
        values = shaded_vec(values, stride, h, at, m, out.sheen);
    if (branch((bits & map_bit(map_sheen_roughness)) != 0))
        out.sheen_roughness = select(m, between_corners(values, h, at.a, at.b, at.c, m), out.sheen_roughness);
}

/// What is shaded where triangles of one block are hit, from its arrays, blended or not.
inline void find_shaded(pointer<float> values, sint stride, sint shading, const Hits& h, const HitCorners& at,
                        const vmask& m, Shaded& out) {
    sint bits = shaded_bits(shading);
    out.bits = select(m, vint(bits), out.bits);
    if (branch((bits & map_bit(map_albedo)) != 0))
        values = shaded_vec(values, stride, h, at, m, out.albedo);
    if (branch((bits & map_bit(map_metallic)) != 0)) {
        out.metallic = select(m, between_corners(values, h, at.a, at.b, at.c, m), out.metallic);
        values = values + stride;
    }
    if (branch((bits & map_bit(map_roughness)) != 0)) {
        out.roughness = select(m, between_corners(values, h, at.a, at.b, at.c, m), out.roughness);
        values = values + stride;
    }
    if (branch((bits & map_bit(map_emission)) != 0))
        values = shaded_vec(values, stride, h, at, m, out.emission);
    if (branch((bits & map_bit(map_normal)) != 0))
        values = shaded_vec(values, stride, h, at, m, out.normal);
    if (branch((bits & sheen_bits) != 0))
        find_shaded_sheen(values, stride, bits, h, at, m, out);
}

} // namespace shade_kernel
} // namespace razor::ISA_TARGET
