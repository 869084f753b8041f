#include "tests/kernels/leave_kernel.h"

#include "razor/kernels/leave.h"

namespace razor::test::ISA_TARGET {

using namespace razor::ISA_TARGET;

void leave(LeaveArguments& a);
void leave(LeaveArguments& a) {
    Context c;
    c.frame = pointer<FrameHeader>(a.frame);
    c.self = pointer<WorkerRecord>(a.self);
    c.packets = pointer<float>(a.packets);
    if (a.forget)
        forget_fields(c);
    vvec none = {vfloat(0.0F), vfloat(0.0F), vfloat(0.0F)};
    Surface s;
    pointer<const float> position(a.position);
    s.position.x = load_vector(position);
    s.position.y = load_vector(position + isa::width);
    s.position.z = load_vector(position + 2 * isa::width);
    s.target = load_vector(pointer<const float>(a.target));
    s.hit = load_vector(pointer<const std::int32_t>(a.hit)) != vint(0);
    s.chord_normal = none;
    s.chord_slope = vfloat(0.0F);
    s.chord_growth = vfloat(0.0F);
    s.block = vint(-1);
    Rays r;
    r.direction = none;
    r.active = s.hit;
    leave_surface(c, s, load_vector(pointer<const float>(a.wanted)), r);
    pointer<float> origin(a.origin);
    store_vector(origin, r.field_origin.x);
    store_vector(origin + isa::width, r.field_origin.y);
    store_vector(origin + 2 * isa::width, r.field_origin.z);
    store_vector(pointer<float>(a.radius), r.radius);
    store_vector(pointer<float>(a.base), r.base);
    store_vector(pointer<float>(a.growth), r.growth);
    store_vector(pointer<std::int32_t>(a.number), r.number);
}

} // namespace razor::test::ISA_TARGET
