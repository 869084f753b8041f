# Debian's OpenSubdiv CMake package names static libraries that Debian does not ship.
find_path(OPENSUBDIV_INCLUDE opensubdiv/bfr/surface.h REQUIRED)
find_library(OPENSUBDIV_CPU osdCPU REQUIRED)
add_library(osd::cpu SHARED IMPORTED)
set_target_properties(osd::cpu PROPERTIES IMPORTED_LOCATION ${OPENSUBDIV_CPU}
                                          INTERFACE_INCLUDE_DIRECTORIES ${OPENSUBDIV_INCLUDE})
