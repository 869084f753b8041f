// Every operation of the vocabulary once, for one target and width.
#include "operations.h"

#include "isa/isa.h"

namespace isa_test::ISA_TARGET {

using namespace isa::ISA_TARGET;

namespace {

using isa::width;

pointer<const float> in(const float* p) { return pointer<const float>(p); }
pointer<const std::int32_t> in(const std::int32_t* p) { return pointer<const std::int32_t>(p); }
std::int32_t* words(result& r) { return reinterpret_cast<std::int32_t*>(r.word); }

// The scalar operands of one lane that each shape has.
struct scalar_floats {
    sfloat sa, sb, sc;
    explicit scalar_floats(const operands& x, int lane)
        : sa(load(in(x.a + lane))), sb(load(in(x.b + lane))), sc(load(in(x.c + lane))) {}
};
struct scalar_integers {
    sint si, sj;
    explicit scalar_integers(const operands& x, int lane) : si(load(in(x.i + lane))), sj(load(in(x.j + lane))) {}
};
struct scalar_masks {
    sbool sm, sn;
    explicit scalar_masks(const operands& x, int lane)
        : sm(load(in(x.m + lane)) != sint(0)), sn(load(in(x.n + lane)) != sint(0)) {}
};
struct scalar_mixed : scalar_floats, scalar_integers, scalar_masks {
    explicit scalar_mixed(const operands& x, int lane)
        : scalar_floats(x, lane), scalar_integers(x, lane), scalar_masks(x, lane) {}
};
using scalar_floats_1 = scalar_floats;
using scalar_floats_2 = scalar_floats;
using scalar_floats_3 = scalar_floats;
using scalar_integers_2 = scalar_integers;

// The operands that each shape has.
struct of_floats_1 {
    vfloat a;
    explicit of_floats_1(const operands& x) : a(load_vector(in(x.a))) {}
};
struct of_floats_2 : of_floats_1 {
    vfloat b;
    explicit of_floats_2(const operands& x) : of_floats_1(x), b(load_vector(in(x.b))) {}
};
struct of_floats_3 : of_floats_2 {
    vfloat c;
    explicit of_floats_3(const operands& x) : of_floats_2(x), c(load_vector(in(x.c))) {}
};
struct of_integers_2 {
    vint i, j;
    explicit of_integers_2(const operands& x) : i(load_vector(in(x.i))), j(load_vector(in(x.j))) {}
};
struct of_masks {
    vmask m, n;
    explicit of_masks(const operands& x) : m(load_vector(in(x.m)) != vint(0)), n(load_vector(in(x.n)) != vint(0)) {}
};
struct of_mixed : of_floats_3, of_integers_2, of_masks, scalar_mixed {
    explicit of_mixed(const operands& x) : of_floats_3(x), of_integers_2(x), of_masks(x), scalar_mixed(x, 0) {}
};

void put(result& r, const vint& x) {
    store_vector(pointer<std::int32_t>(words(r)), x);
    r.count = width;
    r.is = kind::integers;
}
void put(result& r, const vfloat& x) {
    put(r, as_int(x));
    r.is = kind::floats;
}
void put(result& r, const vmask& x) { put(r, select(x, vint(1), vint(0))); }
void put(result& r, const sint& x, int lane = 0) {
    store(pointer<std::int32_t>(words(r) + lane), x);
    r.count = lane + 1;
    r.is = kind::integers;
}
void put(result& r, const sfloat& x, int lane = 0) {
    put(r, as_int(x), lane);
    r.is = kind::floats;
}
void put(result& r, const sbool& x, int lane = 0) { put(r, select(x, sint(1), sint(0)), lane); }

// A copy of lanes that a case may write to: the operands j, and after them the words of a result.
std::int32_t* copy_of_lanes(const operands& x, result& r) {
    for (int lane = 0; lane < 2 * width; ++lane)
        words(r)[lane] = lane < width ? x.j[lane] : -1 - lane;
    r.count = 2 * width;
    r.is = kind::integers;
    return words(r);
}
float* copy_of_floats(const operands& x, result& r) { return reinterpret_cast<float*>(copy_of_lanes(x, r)); }

#define CASE(takes, name, expression)                                                                                  \
    {                                                                                                                  \
        name, shape::takes, 0, 0, [](const operands& memory, result& r) {                                              \
            [[maybe_unused]] of_##takes x(memory);                                                                     \
            put(r, expression);                                                                                        \
        }                                                                                                              \
    }
// Of lane 0 alone.
#define OF_SCALARS(takes, name, expression)                                                                            \
    {                                                                                                                  \
        name, shape::takes, 0, 0, [](const operands& memory, result& r) {                                              \
            scalar_##takes x(memory, 0);                                                                               \
            put(r, expression);                                                                                        \
        }                                                                                                              \
    }
// A scalar operation, on the operands of each lane in turn.
#define SCALAR(takes, name, expression) SCALAR_FUSED(takes, name, 0, 0, expression)
#define SCALAR_FUSED(takes, name, sign, sign_c, expression)                                                            \
    {                                                                                                                  \
        name, shape::takes, sign, sign_c, [](const operands& memory, result& r) {                                      \
            for (int lane = 0; lane < width; ++lane) {                                                                 \
                scalar_##takes x(memory, lane);                                                                        \
                put(r, expression, lane);                                                                              \
            }                                                                                                          \
        }                                                                                                              \
    }
#define FUSED(name, sign, sign_c, expression)                                                                          \
    {                                                                                                                  \
        name, shape::floats_3, sign, sign_c, [](const operands& memory, result& r) {                                   \
            of_floats_3 x(memory);                                                                                     \
            put(r, expression);                                                                                        \
        }                                                                                                              \
    }
#define WRITES(name, statement)                                                                                        \
    {                                                                                                                  \
        name, shape::mixed, 0, 0, [](const operands& memory, result& r) {                                              \
            of_mixed x(memory);                                                                                        \
            statement;                                                                                                 \
        }                                                                                                              \
    }

const operation cases[] = {
    // float lanes
    CASE(floats_2, "a + b", x.a + x.b),
    CASE(floats_2, "a - b", x.a - x.b),
    CASE(floats_2, "a * b", x.a* x.b),
    CASE(floats_2, "a / b", x.a / x.b),
    FUSED("fma", 1, 1, fma(x.a, x.b, x.c)),
    FUSED("fms", 1, -1, fms(x.a, x.b, x.c)),
    FUSED("fnma", -1, 1, fnma(x.a, x.b, x.c)),
    CASE(floats_2, "product_error", product_error(x.a, x.b, x.a* x.b)),
    CASE(floats_2, "min", min(x.a, x.b)),
    CASE(floats_2, "max", max(x.a, x.b)),
    CASE(floats_1, "sqrt", sqrt(x.a)),
    CASE(floats_1, "floor", floor(x.a)),
    CASE(floats_1, "round_even", round_even(x.a)),
    CASE(floats_1, "reciprocal", reciprocal(x.a)),
    CASE(floats_1, "reciprocal_sqrt", reciprocal_sqrt(x.a)),
    CASE(floats_2, "a < b", x.a < x.b),
    CASE(floats_2, "a <= b", x.a <= x.b),
    CASE(floats_2, "a > b", x.a > x.b),
    CASE(floats_2, "a >= b", x.a >= x.b),
    CASE(floats_2, "a == b", x.a == x.b),
    CASE(floats_2, "a != b", x.a != x.b),
    CASE(floats_1, "-a", as_int(-x.a)),
    CASE(floats_1, "abs", as_int(abs(x.a))),
    CASE(floats_1, "to_int", to_int(x.a)),
    CASE(floats_1, "as_int", as_int(x.a)),
    OF_SCALARS(floats_1, "vfloat(scalar)", as_int(vfloat(x.sa))),
    CASE(floats_1, "vfloat(constant)", vfloat(1.5F)),
    CASE(mixed, "select float", as_int(select(x.m, x.a, x.b))),

    // integer lanes
    CASE(integers_2, "i + j", x.i + x.j),
    CASE(integers_2, "i - j", x.i - x.j),
    CASE(integers_2, "i * j", x.i* x.j),
    CASE(integers_2, "i & j", x.i& x.j),
    CASE(integers_2, "i | j", x.i | x.j),
    CASE(integers_2, "i ^ j", x.i ^ x.j),
    CASE(integers_2, "i << j", x.i << x.j),
    CASE(integers_2, "i >> j", x.i >> x.j),
    CASE(integers_2, "shift_right_logical", shift_right_logical(x.i, x.j)),
    CASE(integers_2, "i << 0", x.i << 0),
    CASE(integers_2, "i << 7", x.i << 7),
    CASE(integers_2, "i << 31", x.i << 31),
    CASE(integers_2, "i >> 0", x.i >> 0),
    CASE(integers_2, "i >> 7", x.i >> 7),
    CASE(integers_2, "i >> 31", x.i >> 31),
    CASE(integers_2, "shift_right_logical 0", shift_right_logical(x.i, 0)),
    CASE(integers_2, "shift_right_logical 7", shift_right_logical(x.i, 7)),
    CASE(integers_2, "shift_right_logical 31", shift_right_logical(x.i, 31)),
    CASE(integers_2, "min int", min(x.i, x.j)),
    CASE(integers_2, "max int", max(x.i, x.j)),
    CASE(integers_2, "i < j", x.i < x.j),
    CASE(integers_2, "i <= j", x.i <= x.j),
    CASE(integers_2, "i > j", x.i > x.j),
    CASE(integers_2, "i >= j", x.i >= x.j),
    CASE(integers_2, "i == j", x.i == x.j),
    CASE(integers_2, "i != j", x.i != x.j),
    CASE(integers_2, "to_float", to_float(x.i)),
    CASE(integers_2, "as_float", as_int(as_float(x.i))),
    OF_SCALARS(integers_2, "vint(scalar)", vint(x.si)),
    CASE(integers_2, "vint(constant)", vint(-7)),
    CASE(integers_2, "lane_index", lane_index()),
    OF_SCALARS(integers_2, "first_lanes", first_lanes(x.si)),
    OF_SCALARS(integers_2, "first_lanes small", first_lanes(x.sj& sint(127))),
    CASE(mixed, "select int", select(x.m, x.i, x.j)),

    // masks
    CASE(masks, "m & n", x.m& x.n),
    CASE(masks, "m | n", x.m | x.n),
    CASE(masks, "m ^ n", x.m ^ x.n),
    CASE(masks, "!m", !x.m),
    CASE(masks, "any", any(x.m)),
    CASE(masks, "any !", any(!x.m)),
    CASE(masks, "all", all(x.m)),
    CASE(masks, "all !", all(!x.m)),
    CASE(masks, "none", none(x.m)),
    CASE(masks, "none !", none(!x.m)),
    CASE(masks, "count", count(x.m)),
    CASE(masks, "count !", count(!x.m)),
    CASE(masks, "first", first(x.m)),
    CASE(masks, "first !", first(!x.m)),
    CASE(masks, "clear_first", clear_first(x.m)),
    OF_SCALARS(masks, "vmask(scalar)", vmask(x.sm)),
    CASE(masks, "vmask(true)", vmask(true)),
    CASE(masks, "vmask(false)", vmask(false)),

    // across lanes
    CASE(floats_1, "reduce_add", reduce_add(x.a)),
    CASE(floats_1, "reduce_min", reduce_min(x.a)),
    CASE(floats_1, "reduce_max", reduce_max(x.a)),
    CASE(integers_2, "reduce_add int", reduce_add(x.i)),
    CASE(integers_2, "reduce_min int", reduce_min(x.i)),
    CASE(integers_2, "reduce_max int", reduce_max(x.i)),
    CASE(mixed, "permute float", as_int(permute(x.a, x.j))),
    CASE(mixed, "permute int", permute(x.i, x.j)),
    CASE(mixed, "compress float", as_int(compress(x.a, x.m))),
    CASE(mixed, "compress int", compress(x.i, x.m)),
    CASE(mixed, "extract float", as_int(extract(x.a, x.sj))),
    CASE(mixed, "extract int", extract(x.i, x.sj)),
    CASE(mixed, "extract constant", extract(x.i, sint(5))),

    // scalars
    SCALAR(floats_2, "scalar a + b", x.sa + x.sb),
    SCALAR(floats_2, "scalar a - b", x.sa - x.sb),
    SCALAR(floats_2, "scalar a * b", x.sa* x.sb),
    SCALAR(floats_2, "scalar a / b", x.sa / x.sb),
    SCALAR(floats_1, "scalar -a", as_int(-x.sa)),
    SCALAR_FUSED(floats_3, "scalar fma", 1, 1, fma(x.sa, x.sb, x.sc)),
    SCALAR_FUSED(floats_3, "scalar fms", 1, -1, fms(x.sa, x.sb, x.sc)),
    SCALAR_FUSED(floats_3, "scalar fnma", -1, 1, fnma(x.sa, x.sb, x.sc)),
    SCALAR(floats_2, "scalar product_error", product_error(x.sa, x.sb, x.sa* x.sb)),
    SCALAR(floats_1, "scalar round_even", round_even(x.sa)),
    SCALAR(floats_1, "scalar reciprocal", reciprocal(x.sa)),
    SCALAR(floats_1, "scalar reciprocal_sqrt", reciprocal_sqrt(x.sa)),
    SCALAR(floats_2, "scalar min", min(x.sa, x.sb)),
    SCALAR(floats_2, "scalar max", max(x.sa, x.sb)),
    SCALAR(floats_1, "scalar abs", as_int(abs(x.sa))),
    SCALAR(floats_1, "scalar sqrt", sqrt(x.sa)),
    SCALAR(floats_1, "scalar floor", floor(x.sa)),
    SCALAR(floats_2, "scalar a < b", x.sa < x.sb),
    SCALAR(floats_2, "scalar a <= b", x.sa <= x.sb),
    SCALAR(floats_2, "scalar a > b", x.sa > x.sb),
    SCALAR(floats_2, "scalar a >= b", x.sa >= x.sb),
    SCALAR(floats_2, "scalar a == b", x.sa == x.sb),
    SCALAR(floats_2, "scalar a != b", x.sa != x.sb),
    SCALAR(floats_1, "scalar to_int", to_int(x.sa)),
    SCALAR(floats_1, "scalar as_int", as_int(x.sa)),
    SCALAR(integers_2, "scalar i + j", x.si + x.sj),
    SCALAR(integers_2, "scalar i - j", x.si - x.sj),
    SCALAR(integers_2, "scalar i * j", x.si* x.sj),
    SCALAR(integers_2, "scalar -i", -x.si),
    SCALAR(integers_2, "scalar i & j", x.si& x.sj),
    SCALAR(integers_2, "scalar i | j", x.si | x.sj),
    SCALAR(integers_2, "scalar i ^ j", x.si ^ x.sj),
    SCALAR(integers_2, "scalar i << j", x.si << x.sj),
    SCALAR(integers_2, "scalar i >> j", x.si >> x.sj),
    SCALAR(integers_2, "scalar shift_right_logical", shift_right_logical(x.si, x.sj)),
    SCALAR(integers_2, "scalar min int", min(x.si, x.sj)),
    SCALAR(integers_2, "scalar max int", max(x.si, x.sj)),
    SCALAR(integers_2, "scalar i += j", x.si += x.sj),
    SCALAR(integers_2, "scalar i -= j", x.si -= x.sj),
    SCALAR(integers_2, "scalar ++i", ++x.si),
    SCALAR(integers_2, "scalar --i", --x.si),
    SCALAR(floats_2, "scalar a += b", x.sa += x.sb),
    SCALAR(integers_2, "scalar i < j", x.si < x.sj),
    SCALAR(integers_2, "scalar i <= j", x.si <= x.sj),
    SCALAR(integers_2, "scalar i > j", x.si > x.sj),
    SCALAR(integers_2, "scalar i >= j", x.si >= x.sj),
    SCALAR(integers_2, "scalar i == j", x.si == x.sj),
    SCALAR(integers_2, "scalar i != j", x.si != x.sj),
    SCALAR(integers_2, "scalar to_float", to_float(x.si)),
    SCALAR(integers_2, "scalar as_float", as_int(as_float(x.si))),
    SCALAR(masks, "scalar m & n", x.sm& x.sn),
    SCALAR(masks, "scalar m | n", x.sm | x.sn),
    SCALAR(masks, "scalar m ^ n", x.sm ^ x.sn),
    SCALAR(masks, "scalar !m", !x.sm),
    SCALAR(mixed, "scalar select float", as_int(select(x.sm, x.sa, x.sb))),
    SCALAR(mixed, "scalar select int", select(x.sm, x.si, x.sj)),
    SCALAR(masks, "branch", sint(branch(x.sm) ? 3 : 4)),

    // memory
    CASE(mixed, "load float", as_int(load(in(memory.a) + 3))),
    CASE(mixed, "load int", load(in(memory.i) + (x.sj & sint(width - 1)))),
    CASE(mixed, "load_broadcast float", as_int(load_broadcast(in(memory.a) + 1))),
    CASE(mixed, "load_broadcast int", load_broadcast(in(memory.i) + 1)),
    CASE(mixed, "load_vector float, unaligned", as_int(load_vector(in(memory.a) + 1))),
    CASE(mixed, "load_vector int, unaligned", load_vector(in(memory.i) + 1)),
    CASE(mixed, "load_vector float, masked", as_int(load_vector(in(memory.a) + 1, x.m))),
    CASE(mixed, "load_vector int, masked", load_vector(in(memory.i) + 1, x.m)),
    CASE(mixed, "gather float", as_int(gather(in(memory.a), x.j& vint(width - 1), x.m))),
    CASE(mixed, "gather int", gather(in(memory.i), x.j& vint(width - 1), x.m)),
    CASE(mixed, "gather, wild where masked off", gather(in(memory.i), select(x.m, x.j& vint(width - 1), x.j), x.m)),
    CASE(mixed, "gather, negative indices", gather(in(memory.i) + width, (x.j & vint(width - 1)) - vint(width), x.m)),
    WRITES("store float", store(pointer<float>(copy_of_floats(memory, r)) + 1, x.sa)),
    WRITES("store int", store(pointer<std::int32_t>(copy_of_lanes(memory, r)) + 1, x.si)),
    WRITES("store_vector float", store_vector(pointer<float>(copy_of_floats(memory, r)) + 1, x.a)),
    WRITES("store_vector int", store_vector(pointer<std::int32_t>(copy_of_lanes(memory, r)) + 1, x.i)),
    WRITES("store_vector float, masked", store_vector(pointer<float>(copy_of_floats(memory, r)) + 1, x.a, x.m)),
    WRITES("store_vector int, masked", store_vector(pointer<std::int32_t>(copy_of_lanes(memory, r)) + 1, x.i, x.m)),
    WRITES("scatter float", scatter(pointer<float>(copy_of_floats(memory, r)), x.j& vint(width - 1), x.a, x.m)),
    WRITES("scatter int", scatter(pointer<std::int32_t>(copy_of_lanes(memory, r)), x.j& vint(width - 1), x.i, x.m)),
    WRITES("scatter, equal indices", scatter(pointer<std::int32_t>(copy_of_lanes(memory, r)), x.j& vint(3), x.i, x.m)),
    WRITES("scatter, wild where masked off",
           scatter(pointer<std::int32_t>(copy_of_lanes(memory, r)), select(x.m, x.j& vint(width - 1), x.j), x.i, x.m)),
};

void masked_load(const float* p, const std::int32_t* m, float* to) {
    vmask mask = load_vector(in(m)) != vint(0);
    vfloat x = load_vector(in(p), mask);
    store_vector(pointer<float>(to), x);
}
void masked_store(float* p, const std::int32_t* m, const float* from) {
    vmask mask = load_vector(in(m)) != vint(0);
    vfloat x = load_vector(in(from));
    store_vector(pointer<float>(p), x, mask);
}

} // namespace

operation_list operations();
operation_list operations() {
    return {cases, static_cast<int>(sizeof(cases) / sizeof(cases[0])), width, &masked_load, &masked_store};
}

} // namespace isa_test::ISA_TARGET
