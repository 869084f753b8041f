// The tree of many lights, cut for each hit into as many parts as it has shadow rays: where lights are near
// and bright into the smallest ones, so that those that matter most have rays of their own. In each part one
// of its lights is chosen, down the tree by what is known of both children (Conty Estevez & Kulla, Importance
// Sampling of Many Lights with Adaptive Tree Splitting, HPG 2018; here the number of parts is given, not the
// error of one).
#pragma once

#include "razor/kernels/light_bounds.h"
#include "razor/kernels/shade.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Added to the numbers of pixels for each part of a cut: samples of one have nothing to do with another's.
inline constexpr std::uint32_t part_step = 0xc2b2ae35U;

/// Cuts a tree of lights for each hit, into `parts` or as many as there are lights that may light it: what
/// gives most, and most unevenly, is divided first.
[[gnu::noinline]] inline void cut_lights(const Context& c, pointer<LightNode> nodes, const Surface& s,
                                         sint parts) {
    phase_scope phase(phase_light);
    constexpr int stride = sizeof(LightNode) / 4;
    pointer<std::int32_t> seconds = field(nodes, &LightNode::second);
    pointer<std::int32_t> node_at = as<std::int32_t>(c.cuts) + int{cut_node};
    pointer<float> chance_at = c.cuts + int{cut_chance};
    pointer<float> worth_at = c.cuts + int{cut_worth};
    vfloat zero(0.0F);
    vfloat one(1.0F);
    vfloat done(-1.0F);
    store_vector(node_at, vint(0));
    store_vector(chance_at, one);
    sint second_of_root = load(seconds);
    store_vector(worth_at, select(vmask(second_of_root >= 0), one, done)); // of one light there are no parts
    for (sint k = 1; branch(k < parts); ++k) {
        sint row = k * isa::width;
        store_vector(chance_at + row, zero);
        store_vector(worth_at + row, done);
    }
    vint count(1);
    for (;;) {
        vfloat best = zero;
        vint row(0);
        for (sint k = 0; branch(k < parts); ++k) {
            sint at = k * isa::width;
            vfloat worth = load_vector(worth_at + at);
            vmask more = worth > best;
            best = select(more, worth, best);
            row = select(more, vint(k), row);
        }
        vmask going = s.hit & (count < vint(parts));
        going = going & (best > zero);
        if (branch(none(going))) {
            store_vector(as<std::int32_t>(c.cuts) + int{cut_count}, count);
            return;
        }
        vint at = row * vint(isa::width) + lane_index();
        vint node = gather(node_at, at, going);
        vfloat chance = gather(chance_at, at, going);
        vint first = node + vint(1);
        vint second = gather(seconds, node * vint(stride), going);
        vfloat spread;
        vfloat of_first = importance(bounds_at(nodes, first, going), s.position, s.shading, spread);
        vfloat worth_of_first = of_first * spread;
        vfloat of_second = importance(bounds_at(nodes, second, going), s.position, s.shading, spread);
        vfloat worth_of_second = of_second * spread;
        // Of leaves there is nothing to divide.
        vint below = gather(seconds, first * vint(stride), going);
        worth_of_first = select(below < vint(0), done, worth_of_first);
        below = gather(seconds, second * vint(stride), going);
        worth_of_second = select(below < vint(0), done, worth_of_second);
        vfloat sum = of_first + of_second;
        vfloat share = of_first / max(sum, 1.0e-37F);
        // In its row one of the children that give something, none if there is none; in the next row the
        // other.
        vmask only_second = of_first <= zero;
        vmask both = going & (of_second > zero);
        both = both & !only_second;
        vmask dark = sum <= zero;
        vfloat kept = select(only_second, one, share);
        kept = select(dark, zero, kept);
        vfloat worth = select(only_second, worth_of_second, worth_of_first);
        scatter(node_at, at, select(only_second, second, first), going);
        scatter(chance_at, at, chance * kept, going);
        scatter(worth_at, at, select(dark, done, worth), going);
        vint next = count * vint(isa::width) + lane_index();
        scatter(node_at, next, second, both);
        vfloat rest = one - share;
        scatter(chance_at, next, chance * rest, both);
        scatter(worth_at, next, worth_of_second, both);
        count = select(both, count + vint(1), count);
    }
}

struct LightChoice {
    vint light;
    vfloat chance; // in its part; 0: no light is worth it
};

/// Of the parts with those nodes.
[[gnu::noinline]] inline LightChoice choose_light(pointer<LightNode> nodes, const Surface& s,
                                                  const vint& part, const vfloat& number) {
    constexpr int stride = sizeof(LightNode) / 4;
    pointer<std::int32_t> seconds = field(nodes, &LightNode::second);
    vfloat one(1.0F);
    vfloat left_of = number;
    vint node = part;
    LightChoice choice;
    choice.chance = one;
    vint second = gather(seconds, node * vint(stride), s.hit);
    vmask going = s.hit & (second >= vint(0));
    while (branch(any(going))) {
        vint first = node + vint(1);
        vfloat of_first = importance(bounds_at(nodes, first, going), s.position, s.shading);
        vfloat of_second = importance(bounds_at(nodes, second, going), s.position, s.shading);
        vfloat sum = of_first + of_second;
        vmask dark = going & !(sum > vfloat(0.0F));
        choice.chance = select(dark, vfloat(0.0F), choice.chance);
        going = going & !dark;
        vfloat share = of_first / max(sum, 1.0e-37F);
        vmask low = left_of < share;
        vfloat beyond = left_of - share;
        vfloat rest = one - share;
        vfloat taken = select(low, share, rest);
        vfloat place = select(low, left_of, beyond);
        place = place / max(taken, 1.0e-37F);
        left_of = select(going, min(place, 0.99999994F), left_of);
        choice.chance = select(going, choice.chance * taken, choice.chance);
        node = select(going, select(low, first, second), node);
        vint record = node * vint(stride);
        second = select(going, gather(seconds, record, going), second);
        going = going & (second >= vint(0));
    }
    vmask found = s.hit & (choice.chance > vfloat(0.0F));
    choice.light = select(found, vint(-1) - second, vint(0));
    return choice;
}

/// With which chance the tree leads from its root to a leaf.
[[gnu::noinline]] inline vfloat chance_of_light(pointer<LightNode> nodes, sint leaf, const Surface& from) {
    vfloat chance(1.0F);
    sint child = leaf;
    sint parent = load(field(nodes + child, &LightNode::parent));
    while (branch(parent >= 0)) {
        sint first = parent + 1;
        sint second = load(field(nodes + parent, &LightNode::second));
        vfloat of_first = importance(bounds_of(nodes + first), from.position, from.shading);
        vfloat of_second = importance(bounds_of(nodes + second), from.position, from.shading);
        vfloat own = select(vmask(child == first), of_first, of_second);
        vfloat sum = of_first + of_second;
        chance = chance * (own / max(sum, 1.0e-37F));
        child = parent;
        parent = load(field(nodes + parent, &LightNode::parent));
    }
    return chance;
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
