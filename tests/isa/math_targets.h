// The elementary functions of every target that was built.
#pragma once

#include "math_functions.h"
#include "targets.h"

#define ISA_TEST_DECLARE(target)                                                                                       \
    namespace isa_test::target {                                                                                       \
    math_function_list math_functions();                                                                               \
    }
ISA_TEST_TARGETS(ISA_TEST_DECLARE)
#undef ISA_TEST_DECLARE

namespace isa_test {

struct math_target {
    const char* name;
    math_function_list (*functions)();
};
#define ISA_TEST_ENTRY(name) math_target{#name, &name::math_functions},
inline constexpr math_target math_targets[] = {ISA_TEST_TARGETS(ISA_TEST_ENTRY)};
#undef ISA_TEST_ENTRY

} // namespace isa_test
