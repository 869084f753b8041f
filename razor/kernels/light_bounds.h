// What is known of the lights below a node of their tree, and how much of their light may reach a hit: the
// measure of importance of pbrt-4's LightBounds.
#pragma once

#include "razor/frame/light_node.h"
#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// What a node says, of one node a lane or of one for all.
struct LightBounds {
    vvec low, high, axis;
    vfloat cos_normals, cos_emission, power;
};
inline LightBounds bounds_at(pointer<LightNode> first, const vint& node, const vmask& m) {
    constexpr int stride = sizeof(LightNode) / 4;
    vint record = node * vint(stride);
    LightBounds b;
    b.low = gather_vec(field(first, &LightNode::low), record, vint(1), m);
    b.high = gather_vec(field(first, &LightNode::high), record, vint(1), m);
    b.axis = gather_vec(field(first, &LightNode::axis), record, vint(1), m);
    b.cos_normals = gather(field(first, &LightNode::cos_normals), record, m);
    b.cos_emission = gather(field(first, &LightNode::cos_emission), record, m);
    b.power = gather(field(first, &LightNode::power), record, m);
    return b;
}
inline LightBounds bounds_of(pointer<LightNode> node) {
    LightBounds b;
    b.low = load_broadcast_vec(field(node, &LightNode::low));
    b.high = load_broadcast_vec(field(node, &LightNode::high));
    b.axis = load_broadcast_vec(field(node, &LightNode::axis));
    b.cos_normals = load_broadcast(field(node, &LightNode::cos_normals));
    b.cos_emission = load_broadcast(field(node, &LightNode::cos_emission));
    b.power = load_broadcast(field(node, &LightNode::power));
    return b;
}

inline vfloat sine_of(const vfloat& cosine) {
    vfloat square = fnma(cosine, cosine, vfloat(1.0F));
    return sqrt(max(square, 0.0F));
}
/// Cosine of what angle a is larger than angle b, or 1.
inline vfloat cosine_beyond(const vfloat& cos_a, const vfloat& cos_b) {
    vfloat sine_a = sine_of(cos_a);
    vfloat sines = sine_a * sine_of(cos_b);
    vfloat within = fma(cos_a, cos_b, sines);
    return select(cos_a > cos_b, vfloat(1.0F), within);
}

/// A bound, but for the size of the bounds, on what lights there give to the hit; 0 where they give nothing.
/// `spread`: how much lights there differ by where they are, at most 1.
inline vfloat importance(const LightBounds& b, const vvec& position, const vvec& normal, vfloat& spread) {
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vvec half = (b.high - b.low) * 0.5F;
    vvec way = position - (b.low + half);
    vfloat square = max(dot(way, way), 1.0e-30F);
    vfloat size = dot(half, half);
    vvec towards = way * reciprocal_sqrt(square);
    // The angle in which half of the bounds is seen; all, from inside.
    vfloat seen = one - size / square;
    vmask outside = seen > zero;
    vfloat cos_bounds = select(outside, sqrt(max(seen, 0.0F)), vfloat(-1.0F));
    vfloat cos_axis = min(max(dot(b.axis, towards), -1.0F), 1.0F);
    vfloat cos_normal = cosine_beyond(cos_axis, b.cos_normals);
    vfloat cos_emitted = cosine_beyond(cos_normal, cos_bounds);
    vfloat cos_hit = min(max(-dot(normal, towards), -1.0F), 1.0F);
    vfloat cos_received = cosine_beyond(cos_hit, cos_bounds);
    spread = sqrt(size / max(square, size));
    vmask lit = cos_emitted > b.cos_emission;
    lit = lit & (cos_received > zero);
    vfloat cosines = max(cos_emitted, 0.0F) * cos_received;
    vfloat given = b.power * cosines;
    vfloat value = given / max(square, size);
    return select(lit, value, zero);
}

inline vfloat importance(const LightBounds& b, const vvec& position, const vvec& normal) {
    vfloat spread;
    return importance(b, position, normal, spread);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
