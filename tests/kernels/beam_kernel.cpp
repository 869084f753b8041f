#include "tests/kernels/beam_kernel.h"

#include "razor/kernels/traverse.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

namespace {

vvec three(const float* values) {
    pointer<const float> p(values);
    vvec v;
    v.x = load_vector(p);
    v.y = load_vector(p + isa::width);
    v.z = load_vector(p + 2 * isa::width);
    return v;
}

int value(sbool a) {
    std::int32_t word = 0;
    store(pointer<std::int32_t>(&word), select(a, sint(1), sint(0)));
    return word;
}

} // namespace

void beam(BeamArguments& a);
void beam(BeamArguments& a) {
    Context c;
    c.frame = pointer<FrameHeader>(a.frame);
    c.packets = pointer<float>(a.packets);
    Rays r;
    r.origin = three(a.origin);
    r.direction = three(a.direction);
    r.t_min = vfloat(0.0F);
    r.t_max = load_vector(pointer<const float>(a.t_max));
    vint signs = sign_bits(r.direction);
    Group g = make_group(c, r, vmask(true), sint(a.axis), extract(signs, sint(0)));
    find_beam(c, g, vmask(true), r.t_min, r.t_max);
    svec shift{sfloat(a.shift[0]), sfloat(a.shift[1]), sfloat(a.shift[2])};
    vmask met = boxes_met(g, pointer<const float>(a.boxes), sint(isa::width), shift, sfloat(a.widen), g.begin,
                          g.end, vmask(true));
    vint one(1);
    store_vector(pointer<std::int32_t>(a.met), select(met, one, vint(0)));
    BeamSide side = side_of_beam(c, g, sint(a.plane_axis), sfloat(a.plane));
    a.low = value(side.low);
    a.high = value(side.high);
}

} // namespace razor::test::ISA_TARGET
