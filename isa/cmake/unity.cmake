# RAZOR_UNITY: ten sources of a target are compiled as one. What they include is then read, and what it inlines compiled, once.
set(CMAKE_UNITY_BUILD ${RAZOR_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)

# Sources whose own names, in unnamed namespaces or macros, others of their target have too.
function(compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
