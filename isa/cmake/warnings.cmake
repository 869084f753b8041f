# Warnings for all of the project's own code, as an interface library.
add_library(razor_warnings INTERFACE)
target_compile_options(razor_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion)
if(RAZOR_WERROR)
  target_compile_options(razor_warnings INTERFACE -Werror)
endif()
# Targets must not fuse multiply and add unless asked by name; see isa/README.md.
add_compile_options(-ffp-contract=off)
