# What every target of the house shares: language level, warnings, include roots.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

find_program(SIGHTLINE_CCACHE ccache)
if(SIGHTLINE_CCACHE AND NOT WIN32 AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_CURRENT_LIST_DIR}/through_ccache.sh ${SIGHTLINE_CCACHE})
endif()

function(sightline_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE
    -Wall -Wextra -Wpedantic $<$<BOOL:${SIGHTLINE_WERROR}>:-Werror>
    # GCC 12 sees overlaps in std::string concatenation that are not there (its bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # Clang 19 complains about std::stable_sort as Debian's libstdc++ 12 implements it.
    $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>
    # GCC 12 loses stores where it vectorises straight-line code; nothing measured is faster for it.
    $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
    # Sources that are compiled as one need memory. Tidying it below 1 GB takes a twelfth of g++'s time.
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:--param=ggc-min-heapsize=1000000>
    # The same bits on every machine: a fused multiply-add rounds once, mul and add twice.
    -ffp-contract=off)
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
endfunction()

# sightline_part(NAME FILES...): a part of the library, the object library sightline_NAME.
# The library serves engines and WebAssembly that build without exceptions and RTTI, so it does too.
function(sightline_part name)
  add_library(sightline_${name} OBJECT ${ARGN})
  sightline_target(sightline_${name})
  target_compile_options(sightline_${name} PRIVATE -fno-exceptions -fno-rtti -fvisibility=hidden)
  target_compile_definitions(sightline_${name} PRIVATE SIGHTLINE_BUILD)
  # The first part parses for all what most sources include; where there is a shared library each source begins with
  # what it exports, whatever CMAKE_DISABLE_PRECOMPILE_HEADERS says.
  get_property(shared_is_possible GLOBAL PROPERTY TARGET_SUPPORTS_SHARED_LIBS)
  if(shared_is_possible)
    set_target_properties(sightline_${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS OFF)
    set(exports ${PROJECT_SOURCE_DIR}/bindings/c/exports.hpp)
  else()
    # For sources that are compiled for size: what else clang compares is the same for all.
    target_compile_options(sightline_${name} PRIVATE "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-validate-pch>")
  endif()
  get_property(parts GLOBAL PROPERTY sightline_parts)
  if(parts)
    list(GET parts 0 first)
    sightline_precompile(sightline_${name} LIKE ${first})
  else()
    sightline_precompile(sightline_${name} ${exports} <algorithm> <bit> <cmath> <vector> <glm/glm.hpp>)
  endif()
  set_target_properties(sightline_${name} PROPERTIES UNITY_BUILD OFF)
  target_link_libraries(sightline_${name} PRIVATE sightline_dependencies)
  set_property(GLOBAL APPEND PROPERTY sightline_parts sightline_${name})
endfunction()

# sightline_module(FOLDER FILES...): one folder of the library.
function(sightline_module folder)
  list(TRANSFORM ARGN PREPEND ${folder}/ OUTPUT_VARIABLE files)
  sightline_part(${folder} ${files})
  # Several sources are compiled as one where a build asks for that, but those that Highway includes again for each
  # vector target; and not for WebAssembly, where sources are compiled for size one by one.
  if(CMAKE_UNITY_BUILD AND NOT CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32)
    foreach(file IN LISTS files)
      file(STRINGS ${file} kernel REGEX "hwy/foreach_target.h" LIMIT_COUNT 1)
      if(kernel)
        set_source_files_properties(${file} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endforeach()
    set_target_properties(sightline_${folder} PROPERTIES UNITY_BUILD ON)
    # Of sources that are compiled as one g++ says what it would of headers.
    target_compile_options(sightline_${folder} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# sightline_workbench_module(FOLDER FILES...): one folder of the workbench, a static library of the folder's name.
function(sightline_workbench_module folder)
  add_library(sightline_${folder} STATIC ${ARGN})
  sightline_target(sightline_${folder})
  target_link_libraries(sightline_${folder} PUBLIC sightline fmt::fmt PRIVATE sightline_dependencies)
  set_property(GLOBAL APPEND PROPERTY sightline_workbench_modules sightline_${folder})
endfunction()

# sightline_precompile(TARGET HEADERS...): parses what most sources of the target include once. Only headers of others:
# one's own are included where they are used. sightline_precompile(TARGET LIKE OTHER): the same headers, parsed once for both.
function(sightline_precompile name)
  if(ARGV1 STREQUAL LIKE)
    target_precompile_headers(${name} REUSE_FROM ${ARGV2})
  else()
    target_precompile_headers(${name} PRIVATE ${ARGN})
  endif()
  # For ccache: the same header gives the same bytes.
  target_compile_options(${name} PRIVATE "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endfunction()
