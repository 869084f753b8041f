# Warnings for all of the project's own code, as an interface library.
add_library(razor_warnings INTERFACE)
target_compile_options(razor_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion)
if(RAZOR_WERROR)
  target_compile_options(razor_warnings INTERFACE -Werror)
endif()
# Targets must not fuse multiply and add unless asked by name; see isa/README.md.
add_compile_options(-ffp-contract=off)
# g++ 12 loses the rounding of pairs of doubles to float and back where it packs them into vectors (-O2, -O3).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-fno-tree-slp-vectorize)
endif()
