// The elementary functions of one target.
#include "math_functions.h"

#include "isa/math.h"

namespace isa_test::ISA_TARGET {

using namespace isa::ISA_TARGET;

namespace {

template <class Op> void vectors(const float* x, const float* y, float* r, int n, Op op) {
    for (int i = 0; i < n; i += isa::width) {
        vfloat a = load_vector(pointer<const float>(x + i));
        vfloat b = load_vector(pointer<const float>(y + i));
        store_vector(pointer<float>(r + i), op(a, b));
    }
}
template <class Op> void scalars(const float* x, const float* y, float* r, int n, Op op) {
    for (int i = 0; i < n; ++i) {
        sfloat a = load(pointer<const float>(x + i));
        sfloat b = load(pointer<const float>(y + i));
        store(pointer<float>(r + i), op(a, b));
    }
}

#define FUNCTION(name, call)                                                                                           \
    {                                                                                                                  \
        name,                                                                                                          \
            [](const float* x, const float* y, float* r, int n) {                                                      \
                vectors(x, y, r, n,                                                                                    \
                        []([[maybe_unused]] const vfloat& a, [[maybe_unused]] const vfloat& b) { return call; });      \
            },                                                                                                         \
            [](const float* x, const float* y, float* r, int n) {                                                      \
                scalars(x, y, r, n,                                                                                    \
                        []([[maybe_unused]] const sfloat& a, [[maybe_unused]] const sfloat& b) { return call; });      \
            }                                                                                                          \
    }

constexpr math_function functions[] = {
    FUNCTION("exp", exp(a)), FUNCTION("exp2", exp2(a)), FUNCTION("log", log(a)),    FUNCTION("log2", log2(a)),
    FUNCTION("sin", sin(a)), FUNCTION("cos", cos(a)),   FUNCTION("pow", pow(a, b)), FUNCTION("atan2", atan2(a, b)),
};

} // namespace

math_function_list math_functions();
math_function_list math_functions() { return {functions, functions + sizeof(functions) / sizeof(functions[0])}; }

} // namespace isa_test::ISA_TARGET
