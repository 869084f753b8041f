# Kernel sources are compiled once a target, each target its own object library with its own flags.
#   razor_kernels(NAME SOURCES...)   makes object libraries NAME_plain, NAME_sse4, ... for RAZOR_TARGETS
# A source sees ISA_TARGET (the namespace), ISA_TARGET_<NAME> and ISA_WIDTH.
set(ISA_FLAGS_plain "")
set(ISA_FLAGS_sse4 -msse4.2)
set(ISA_FLAGS_avx2 -mavx2 -mfma -mbmi -mbmi2 -mlzcnt)
set(ISA_FLAGS_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mavx512cd -mavx2 -mfma -mbmi -mbmi2 -mlzcnt
                     -mprefer-vector-width=512)

# `simulated` takes its values from a fused native header: the best that every machine of this kind has.
file(READ /proc/cpuinfo _cpuinfo LIMIT 16384)
if(_cpuinfo MATCHES " avx2 ")
  set(_values avx2)
else()
  set(_values plain)
endif()
set(RAZOR_SIMULATED_VALUES ${_values} CACHE STRING "where the simulated target takes its values: plain, avx2 or avx512")
string(TOUPPER ${RAZOR_SIMULATED_VALUES} _VALUES)
set(ISA_FLAGS_simulated ${ISA_FLAGS_${RAZOR_SIMULATED_VALUES}} -DISA_VALUES_${_VALUES}=1)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  # Vectors of several registers press on the sixteen there are: fewer are alive at once, and fewer copied, with these.
  foreach(ISA sse4 avx2)
    list(APPEND ISA_FLAGS_${ISA} -flive-range-shrinkage -frename-registers)
  endforeach()
endif()

# Flags and definitions of one target and logical width, for any CMake target that includes isa/isa.h. A width other than
# RAZOR_WIDTH is for tests: one program holds one width, and links nothing that was compiled for another.
function(isa_compile_for CMAKE_TARGET ISA WIDTH)
  set_target_properties(${CMAKE_TARGET} PROPERTIES UNITY_BUILD OFF) # what is inlined into what is the sources' choice
  string(TOUPPER ${ISA} ISA_UPPER)
  target_compile_options(${CMAKE_TARGET} PRIVATE -fno-math-errno ${ISA_FLAGS_${ISA}})
  target_compile_definitions(${CMAKE_TARGET} PRIVATE ISA_TARGET=${ISA} ISA_TARGET_${ISA_UPPER}=1 ISA_WIDTH=${WIDTH})
  target_include_directories(${CMAKE_TARGET} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${CMAKE_TARGET} PRIVATE razor_warnings)
endfunction()

# The same at the configured width, with what host code shares.
function(isa_configure CMAKE_TARGET ISA)
  isa_compile_for(${CMAKE_TARGET} ${ISA} ${RAZOR_WIDTH})
  target_link_libraries(${CMAKE_TARGET} PRIVATE isa)
endfunction()

function(razor_kernels NAME)
  foreach(ISA ${RAZOR_TARGETS})
    add_library(${NAME}_${ISA} OBJECT ${ARGN})
    isa_configure(${NAME}_${ISA} ${ISA})
    target_include_directories(${NAME}_${ISA} PRIVATE ${PROJECT_SOURCE_DIR})
  endforeach()
endfunction()
