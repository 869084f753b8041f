# cmake -DNM=nm -DOUTPUT=code_size.cpp -DPHASES=phases.h -DOBJECTS=avx2=kernels.cpp.o,... -P code_size.cmake
#
# Writes the table of code_size.h from the symbols of the kernels' object files. A function's phase is the namespace
# PHASE_kernel that it lies in; its plan is the Features that it is
# instantiated for, or all, and the look whose file it is in.
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${PHASES} PHASES REGEX "^ +phase_[a-z]+,")
list(TRANSFORM PHASES REPLACE "^ +phase_([a-z]+),.*" "\\1")
string(REPLACE "," ";" OBJECTS "${OBJECTS}")
set(TARGETS "")
foreach(OBJECT IN LISTS OBJECTS)
  string(REGEX MATCH "^([a-z0-9]+)=(.*)$" _ "${OBJECT}")
  set(TARGET ${CMAKE_MATCH_1})
  list(APPEND TARGETS ${TARGET})
  execute_process(COMMAND ${NM} -P --defined-only ${CMAKE_MATCH_2} OUTPUT_VARIABLE LISTING COMMAND_ERROR_IS_FATAL ANY)
  # A constructor has two names (C1, C2) and one body.
  string(REGEX REPLACE "([CD])2E" "\\11E" LISTING "${LISTING}")
  string(REPLACE "\n" ";" LISTING "${LISTING}")
  list(REMOVE_DUPLICATES LISTING)
  foreach(LINE IN LISTS LISTING)
    # Not what only tests and benchmarks call.
    if(LINE MATCHES "9trace_all|9build_all" OR NOT LINE MATCHES "^([^ ]+) [tTwW] [0-9a-f]+ ([0-9a-f]+)")
      continue()
    endif()
    set(NAME ${CMAKE_MATCH_1})
    set(BYTES 0x${CMAKE_MATCH_2})
    set(PHASE common)
    if(NAME MATCHES "^_ZZ*N[VK]*5razor[0-9]+${TARGET}[0-9]+([a-z]+)_kernel")
      set(PHASE ${CMAKE_MATCH_1})
      if(NOT PHASE IN_LIST PHASES)
        message(FATAL_ERROR "${NAME}: there is no phase ${PHASE}")
      endif()
    endif()
    # The linker keeps one of what several files have.
    if(DEFINED SEEN_${TARGET}_${NAME})
      continue()
    endif()
    set(SEEN_${TARGET}_${NAME} TRUE)
    # What is not a look's own in kernels.cpp serves them all.
    set(OWN 0)
    if(OBJECT MATCHES "/glossy_mapped")
      set(OWN 3)
    elseif(OBJECT MATCHES "/glossy")
      set(OWN 2)
    elseif(OBJECT MATCHES "/mapped")
      set(OWN 1)
    endif()
    foreach(LOOK 0 1 2 3)
      foreach(GRIDS 0 1)
        if(NAME MATCHES "8FeaturesE(Lb([01])E)?E" AND NOT "0${CMAKE_MATCH_2}" EQUAL GRIDS
           OR NOT LOOK EQUAL OWN AND (NOT OWN EQUAL 0 OR NAME MATCHES "5Matte|12MatteSampler|4LookE0E"))
          continue()
        endif()
        math(EXPR BYTES_${TARGET}_${LOOK}_${GRIDS}_${PHASE} "${BYTES_${TARGET}_${LOOK}_${GRIDS}_${PHASE}} + ${BYTES}")
      endforeach()
    endforeach()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES TARGETS)

set(ROWS "")
list(LENGTH TARGETS COUNT)
foreach(TARGET IN LISTS TARGETS)
  set(TABLE "")
  set(COMMON "")
  foreach(LOOK 0 1 2 3)
    set(TABLES "")
    set(COMMONS "")
    foreach(GRIDS 0 1)
      set(ROW "")
      foreach(PHASE IN LISTS PHASES)
        math(EXPR BYTES "${BYTES_${TARGET}_${LOOK}_${GRIDS}_${PHASE}} + 0")
        string(APPEND ROW "${BYTES}, ")
      endforeach()
      string(APPEND TABLES "{${ROW}}, ")
      math(EXPR BYTES "${BYTES_${TARGET}_${LOOK}_${GRIDS}_common} + 0")
      string(APPEND COMMONS "${BYTES}, ")
    endforeach()
    string(APPEND TABLE "{${TABLES}}, ")
    string(APPEND COMMON "{${COMMONS}}, ")
  endforeach()
  string(APPEND ROWS "    {\"${TARGET}\", {${TABLE}}, {${COMMON}}},\n")
endforeach()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "// Written by code_size.cmake.
#include \"razor/kernels/code_size.h\"

#include <array>

namespace razor {

static_assert(look_count == 4 && grids_count == 2);
static constexpr std::array<CodeSize, @COUNT@> table = {{
@ROWS@}};
std::span<const CodeSize> code_sizes() {
    return table;
}

} // namespace razor
")
