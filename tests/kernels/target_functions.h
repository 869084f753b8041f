// A test's own functions of kernels, compiled for every target (razor_kernels() in CMakeLists.txt).
#pragma once

#include "test_targets.h"
#include "tests/kernels/targets.h"

namespace razor::test {

/// `run` is compiled for the target `name`; Parameter: a reference to what it takes.
template <class Parameter> struct TargetFunction {
    const char* name;
    void (*run)(Parameter);
};

} // namespace razor::test

#define RAZOR_DECLARE_FUNCTION(target, function, Parameter)                                                  \
    namespace target {                                                                                       \
    void function(Parameter a);                                                                              \
    }
#define RAZOR_LIST_FUNCTION(target, function, Parameter) {#target, target::function},

/// In namespace razor::test: function_of_targets() are those that this processor can run.
#define RAZOR_TEST_FUNCTION(function, Parameter)                                                             \
    RAZOR_TEST_TARGETS(RAZOR_DECLARE_FUNCTION, function, Parameter)                                          \
    inline std::vector<TargetFunction<Parameter>> function##_of_targets() {                                  \
        return of_targets<TargetFunction<Parameter>>(                                                        \
            {RAZOR_TEST_TARGETS(RAZOR_LIST_FUNCTION, function, Parameter)}, all_targets());                  \
    }
