// The order in which a packet's hits share packets of shadow rays. Hits side by side on the screen may lie
// far apart, on leaves and on what is behind them; rays of those that lie near each other meet fewer nodes,
// blocks and boxes.
#pragma once

#include "razor/frame/scratch.h"
#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {
inline namespace light_kernel {

/// Bitonic sorting (Batcher, "Sorting networks and their applications", AFIPS 1968): ascending, no two alike.
inline vint sort_lanes(vint key) {
    for (int run = 2; run <= isa::width; run *= 2)
        for (int step = run / 2; step > 0; step /= 2) {
            vint other = permute(key, lane_index() ^ vint(step));
            vmask higher = (lane_index() & vint(step)) != vint(0);
            if (run < isa::width) { // every other run descends
                vmask descends = (lane_index() & vint(run)) != vint(0);
                higher = higher ^ descends;
            }
            vint low = min(key, other);
            vint high = max(key, other);
            key = select(higher, high, low);
        }
    return key;
}

/// The lanes of m, along the axis along which their places are spread most (to 2^-17 of that, then by their
/// numbers); after them the other lanes. All lanes are there also where places are no numbers.
[[gnu::noinline]] inline vint near_order(const vvec& place, const vmask& m) {
    vfloat far(infinite);
    const vfloat* along[3] = {&place.x, &place.y, &place.z};
    vfloat at = place.x;
    sfloat begin = 0.0F;
    sfloat widest = 0.0F;
    for (const vfloat* axis : along) {
        sfloat least = reduce_min(select(m, *axis, far));
        sfloat most = reduce_max(select(m, *axis, -far));
        sfloat extent = most - least;
        if (branch(extent > widest)) {
            at = *axis;
            begin = least;
            widest = extent;
        }
    }
    constexpr float below_one = 1 - 1.0F / 1024;
    sfloat scale = sfloat(below_one) / select(widest > 0.0F, widest, sfloat(1.0F));
    vfloat share = at - vfloat(begin);
    share = share * vfloat(scale);
    share = min(max(share, 0.0F), below_one);
    // Bits of numbers from 1 to 2 ascend as these do; the last ones make room for the lane.
    constexpr int lane_bits = isa::width - 1;
    vint key = as_int(share + 1.0F) & vint(~lane_bits);
    key = select(m, key, vint(0x40000000));
    key = sort_lanes(key | lane_index());
    return key & vint(lane_bits);
}

} // namespace light_kernel
} // namespace razor::ISA_TARGET
