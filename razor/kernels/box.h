// Boxes: what has to lie in them is rounded outward by whoever makes them.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace tessellate_kernel {

struct Box {
    svec low, high;
};

/// That of two boxes.
inline Box hold(const Box& a, const Box& b) {
    Box r;
    r.low = {min(a.low.x, b.low.x), min(a.low.y, b.low.y), min(a.low.z, b.low.z)};
    r.high = {max(a.high.x, b.high.x), max(a.high.y, b.high.y), max(a.high.z, b.high.z)};
    return r;
}
/// What is in both of two boxes that overlap.
inline Box common(const Box& a, const Box& b) {
    Box r;
    r.low = {max(a.low.x, b.low.x), max(a.low.y, b.low.y), max(a.low.z, b.low.z)};
    r.high = {min(a.high.x, b.high.x), min(a.high.y, b.high.y), min(a.high.z, b.high.z)};
    return r;
}

/// The box of a block and of all finer ones, the instance's coordinates.
inline Box box_of(pointer<BlockHeader> block) {
    Box box;
    box.low = load_svec(field(block, &BlockHeader::box_low));
    box.high = load_svec(field(block, &BlockHeader::box_high));
    return box;
}
inline void store_box(pointer<BlockHeader> block, const Box& box) {
    store_svec(field(block, &BlockHeader::box_low), box.low);
    store_svec(field(block, &BlockHeader::box_high), box.high);
}

} // namespace tessellate_kernel
} // namespace razor::ISA_TARGET
