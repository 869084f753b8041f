// A packet of rays against the two triangles of a quad. Watertight (Woop, Benthin & Wald, JCGT 2013): every
// vertex is sheared into the ray's frame, edge functions of shared edges are the same bits with opposite
// signs, and an edge function that rounds to zero is decided by its exact error terms. Lanes are rays;
// vertices are broadcast.
#pragma once

#include "razor/kernels/blend.h"
#include "razor/kernels/fields.h"

namespace razor::ISA_TARGET {
inline namespace intersect_kernel {

/// What inner loops are compiled for. The plan picks an instantiation; absent features leave no branch there.
struct Features {
    bool hanging = true; // some patch has sides coarser than its grid
};

struct Hits {
    vfloat t;
    vfloat u, v;   // barycentric weights of the triangle's second and third vertex
    vint patch;    // -1: none
    vint triangle; // block number * 128 + quad (row * 8 + column) * 2 + which
    vint block;    // first line of the block in the grids
    vint field;    // the lane whose field the block was blended for; -1: it was not
};

/// Lines of x and y over z below and above rays, where z is between `begin` and `end` (beam.h).
struct Beam {
    sfloat begin, end;
    sfloat low_base[2], low_rate[2];
    sfloat high_base[2], high_rate[2];
};

/// A group of rays of one packet whose directions are long along one axis, with all that is common to them.
struct Group {
    vmask alive;
    sint kx, ky, kz;         // permutation: z is that axis
    vfloat ox, oy, oz;       // origin, permuted
    vfloat shear_x, shear_y; // d_x / d_z, d_y / d_z
    vfloat scale_z;          // 1 / d_z
    vfloat t_min;
    sbool mixed[3]; // whether the directions' components differ in sign (unpermuted axes)
    sint sign[3];   // 1: the component is negative; of the first ray, where they differ
    Beam beam;
    sfloat begin, end; // of the part of the beam that is in the cell at hand
    sfloat slack;      // of positions
    sbool morphs;      // whether vertices leave their anchors
    sbool leaves;      // whether some ray leaves a block for good
    FieldBounds fields;
};

struct Projected {
    vfloat x, y, z;
};

/// p x q - their order's edge function; exact in sign unless it is zero.
inline vfloat edge_function(const Projected& p, const Projected& q) {
    vfloat a = p.x * q.y;
    vfloat b = p.y * q.x;
    return a - b;
}
/// The same, exact in sign always: where the rounded products are equal, their errors decide.
inline vfloat exact_edge_function(const Projected& p, const Projected& q) {
    vfloat a = p.x * q.y;
    vfloat b = p.y * q.x;
    vfloat d = a - b;
    vfloat a_error = product_error(p.x, q.y, a);
    vfloat b_error = product_error(p.y, q.x, b);
    vfloat tie = a_error - b_error;
    return select(d == vfloat(0.0F), tie, d);
}

/// The block as the group sees it: permuted component arrays, origin moved to mesh coordinates.
struct View {
    pointer<float> x, y, z;
    pointer<float> words;
    vfloat ox, oy, oz;
    sint line, patch, number, triangles;
    sint from; // a SeenFrom
    sint quads_u, quads_v;
    sint cells_at, ancestors_at, hang[4], hangs;
    /// log2 of the sub-edges on the longest edge that a coarser block may have in their place; hang or more.
    sint longest[4];
    sint field; // as in Hits
};

inline Projected project(const Group& g, const View& v, const vfloat& x, const vfloat& y, const vfloat& z) {
    vfloat px = x - v.ox;
    vfloat py = y - v.oy;
    Projected p;
    p.z = z - v.oz;
    p.x = fnma(g.shear_x, p.z, px);
    p.y = fnma(g.shear_y, p.z, py);
    return p;
}
[[gnu::always_inline]] inline Projected project_vertex(const Group& g, const View& v, sint i) {
    vfloat x = load_broadcast(v.x + i);
    vfloat y = load_broadcast(v.y + i);
    vfloat z = load_broadcast(v.z + i);
    return project(g, v, x, y, z);
}

/// Of the lanes that meet triangle `number` at distance t, those for which it is the first hit so far.
[[gnu::always_inline]] inline vmask nearer(const Group& g, const View& v, const vmask& inside,
                                           const vfloat& t, const vint& number, const Hits& hits) {
    vmask first = t < hits.t;
    vmask equal = t == hits.t;
    if (branch(any(inside & equal))) {
        vint patch = vint(v.patch);
        vmask lower = patch < hits.patch;
        vmask same = patch == hits.patch;
        same = same & (number < hits.triangle);
        lower = lower | same;
        lower = lower | (hits.patch < vint(0));
        first = first | (equal & lower);
    }
    vmask hit = inside & first;
    return hit & (t >= g.t_min);
}

[[gnu::always_inline]] inline void record(const View& v, const vmask& hit, const vfloat& t, const vfloat& u,
                                          const vfloat& w, const vint& number, Hits& hits) {
    hits.t = select(hit, t, hits.t);
    hits.u = select(hit, u, hits.u);
    hits.v = select(hit, w, hits.v);
    hits.patch = select(hit, vint(v.patch), hits.patch);
    hits.triangle = select(hit, number, hits.triangle);
    hits.block = select(hit, vint(v.line), hits.block);
    hits.field = select(hit, vint(v.field), hits.field);
}

/// Of the lanes that hit, those whose hits count there: all.
inline vmask counted(const View&, const vmask& hit, const vfloat&) {
    return hit;
}

/// Whether rays come from where a triangle is seen; `det`: twice its area as they see it, positive where its
/// vertices run counter-clockwise about the axis that the rays are sheared along.
inline vmask is_seen(const Group& g, const View& v, const vfloat& det) {
    vint sides = as_int(det) ^ as_int(g.scale_z);
    vmask front = sides < vint(0);
    vmask mirrored = vmask(v.from == seen_from_mirrored_front);
    return front ^ mirrored;
}

/// Takes the hits of triangle (a, b, c) with edge functions U (opposite a), V, W, all in one sense: of
/// counter-clockwise triangles, or Reversed.
template <bool Reversed, class Seen>
[[gnu::always_inline]] inline void accept(const Group& g, const Seen& v, vmask inside, vfloat U, vfloat V,
                                          vfloat W, const Projected& a, const Projected& b,
                                          const Projected& c, sint triangle, Hits& hits) {
    vfloat sum = U + V;
    vfloat det = sum + W;
    inside = inside & (det != vfloat(0.0F));
    vfloat inverse = reciprocal(det);
    vfloat depth = fma(U, a.z, fma(V, b.z, W * c.z));
    vfloat t = depth * g.scale_z * inverse;
    vint number = vint(triangle);
    vmask hit = nearer(g, v, inside, t, number, hits);
    hit = counted(v, hit, t);
    if (branch(any(hit))) {
        if (branch(v.from != seen_from_both_sides))
            hit = hit & is_seen(g, v, Reversed ? -det : det);
        vfloat u = V * inverse;
        vfloat w = W * inverse;
        record(v, hit, t, u, w, number, hits);
    }
}

/// Lanes for which the three edge functions agree in sign; zero agrees with both.
inline vmask agree(const vfloat& u, const vfloat& v, const vfloat& w) {
    vfloat zero(0.0F);
    vfloat least = min(u, min(v, w));
    vfloat most = max(u, max(v, w));
    vmask same = least >= zero;
    return same | (most <= zero);
}

/// For lanes that may hit the quad's triangles, (00, 10, 11) and (00, 11, 01): decides exactly, and takes the
/// hits. Seldom called and out of line, so that the inner loop keeps nothing for it: it projects the vertices
/// again.
template <class Seen>
[[gnu::noinline]] inline void hit_quad(const Group& g, const Seen& v, sint i, sint j, sint low, sint high,
                                       vmask inside0, vmask inside1, Hits& hits) {
    Projected p00 = project_vertex(g, v, low);
    Projected p10 = project_vertex(g, v, low + 1);
    Projected p11 = project_vertex(g, v, high + 1);
    Projected p01 = project_vertex(g, v, high);
    sint quad = ((j << block_log2) + i) * 2;
    sint triangle = (v.number << 7) + quad;
    vfloat minus = exact_edge_function(p11, p00);
    if (branch(any(inside0))) {
        vfloat right = exact_edge_function(p10, p11);
        vfloat bottom = exact_edge_function(p00, p10);
        inside0 = inside0 & agree(right, minus, bottom);
        accept<false>(g, v, inside0, right, minus, bottom, p00, p10, p11, triangle, hits);
    }
    sbool second = v.triangles > 1;
    if (branch(second & any(inside1))) {
        // All three the other way round: only their ratios count.
        vfloat top = exact_edge_function(p01, p11);
        vfloat left = exact_edge_function(p00, p01);
        inside1 = inside1 & agree(top, left, minus);
        accept<true>(g, v, inside1, top, left, minus, p00, p11, p01, triangle + 1, hits);
    }
}

} // namespace intersect_kernel
} // namespace razor::ISA_TARGET
