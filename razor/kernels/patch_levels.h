// One level a patch, to compare with: each ray takes every patch whole at the coarsest level that is fine
// enough for it anywhere in the box of the patch, as PRMan does (Christensen et al., "Ray tracing for the
// movie 'Cars'", 2006). Nothing is blended, and between patches of different levels there are cracks.
#pragma once

#include "razor/kernels/intersect.h"

namespace razor::ISA_TARGET {
inline namespace traverse_kernel {

/// The least target edge length of each lane in the box of a block's patch: that of its coarsest block.
inline vfloat least_in_patch(const Context& c, const Group& g, pointer<BlockHeader> block) {
    sint patch = load(field(block, &BlockHeader::patch));
    sint line = load(field(c.open + patch, &OpenPatch::root));
    pointer<BlockHeader> root = as<BlockHeader>(c.grids + line);
    sint instance = load(field(root, &BlockHeader::instance));
    svec origin = load_svec(field(c.instances + instance, &InstanceRecord::origin));
    svec low = load_svec(field(root, &BlockHeader::box_low)) + origin;
    svec high = load_svec(field(root, &BlockHeader::box_high)) + origin;
    return targets_in(c, g.fields, low, high, g.slack).least;
}

/// The blocks of a leaf, each for the rays that take its patch at its level. Returns the rays for which a
/// block is too coarse. Which rays take a block depends on nothing else, so that it goes into the mailbox as
/// soon as they have met it.
template <Features F, bool AnyHit, bool Mixed>
inline vmask intersect_patches(const Context& c, Group& g, pointer<ItemList> list, const Interval& cell,
                               Hits& hits) {
    pointer<std::int32_t> mailbox = as<std::int32_t>(c.stack + scratch_mailbox);
    vmask alive = g.alive;
    vmask deeper = vmask(false);
    vfloat least(0.0F);
    sint least_of = -1; // the patch that `least` is of
    sint n = load(field(list, &ItemList::count));
    sint stride = load(field(list, &ItemList::stride));
    pointer<float> words = as<float>(list) + item_list_words;
    pointer<std::int32_t> items = as<std::int32_t>(words);
    Listed listed;
    listed.box_step = stride;
    listed.level = load(field(list, &ItemList::level));
    for (sint i = 0; branch(i < n); ++i) {
        sint item = load(items + i);
        listed.line = sint(-1) - item;
        pointer<BlockHeader> block = as<BlockHeader>(c.grids + listed.line);
        sint patch = load(field(block, &BlockHeader::patch));
        if (branch(patch != least_of)) {
            least = least_in_patch(c, g, block);
            least_of = patch;
        }
        sint level = load(field(block, &BlockHeader::level));
        sint absolute = load(field(block, &BlockHeader::absolute));
        sint parent = load(field(block, &BlockHeader::parent));
        vmask takes = least >= vfloat(power_of_two(absolute));
        if (branch(level > 0))
            deeper = deeper | (alive & !takes);
        else
            takes = vmask(true); // there is nothing finer
        if (branch(parent >= 0))
            takes = takes & (least < vfloat(power_of_two(absolute + 1)));
        sint slot = (listed.line >> 2) & (mailbox_slots - 1);
        sint seen = load(mailbox + slot);
        if (branch(seen == listed.line))
            continue;
        g.alive = alive & takes;
        if (branch(none(g.alive)))
            continue;
        listed.box = words + stride + i;
        sbool tested = intersect_block<F, Mixed>(c, g, listed, cell, hits);
        if (branch(tested))
            store(mailbox + slot, listed.line);
        if constexpr (AnyHit) {
            vmask hit = hits.patch >= vint(0);
            alive = alive & !hit;
            hits.t = select(hit, vfloat(-infinite), hits.t);
        }
    }
    g.alive = alive;
    return deeper & alive;
}

} // namespace traverse_kernel
} // namespace razor::ISA_TARGET
