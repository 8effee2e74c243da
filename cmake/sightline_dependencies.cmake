# What the library stands on: Highway and GLM; Roaring bitmaps and zstd for files of visible sets, where they are found.
set(SIGHTLINE_LIBRARIES "")  # what a program links beside the library

if(CMAKE_CROSSCOMPILING)
  # This machine's packages are for its own processor, but their headers serve any: Highway's without its library choose
  # the vector instructions when they are compiled. Linked to one by one, for what stands beside them serves no other.
  find_path(SIGHTLINE_PORTABLE_HEADERS hwy/highway.h PATHS /usr/include NO_CMAKE_FIND_ROOT_PATH NO_DEFAULT_PATH REQUIRED)
  add_library(sightline_portable_headers INTERFACE)
  set(folder ${CMAKE_BINARY_DIR}/portable_headers)
  file(MAKE_DIRECTORY ${folder})
  foreach(name hwy glm)
    file(CREATE_LINK ${SIGHTLINE_PORTABLE_HEADERS}/${name} ${folder}/${name} SYMBOLIC)
  endforeach()
  target_include_directories(sightline_portable_headers SYSTEM INTERFACE ${folder})
  target_compile_definitions(sightline_portable_headers INTERFACE HWY_COMPILE_ONLY_STATIC)
  set(headers sightline_portable_headers)
  set(pvs_found OFF)
else()
  find_package(hwy REQUIRED)
  find_package(glm REQUIRED)
  set(headers hwy::hwy glm::glm)
  list(APPEND SIGHTLINE_LIBRARIES hwy::hwy)
  find_package(roaring QUIET)
  find_package(zstd QUIET)
  set(pvs_found OFF)
  if(roaring_FOUND AND zstd_FOUND)
    set(pvs_found ON)
  endif()
endif()

option(SIGHTLINE_PVS "Read and write files of potentially visible sets (needs roaring and zstd)" ${pvs_found})
message(STATUS "Sightline: files of potentially visible sets (roaring, zstd): ${SIGHTLINE_PVS}")
if(SIGHTLINE_PVS)
  find_package(roaring REQUIRED)
  find_package(zstd REQUIRED)
  list(APPEND SIGHTLINE_LIBRARIES roaring::roaring zstd::libzstd_shared)
elseif(SIGHTLINE_WORKBENCH)
  message(FATAL_ERROR "The workbench bakes visible sets: it needs SIGHTLINE_PVS, which is libroaring-dev and libzstd-dev")
endif()

# What the library's own sources need; nothing of it stands in a public header.
add_library(sightline_dependencies INTERFACE)
target_link_libraries(sightline_dependencies INTERFACE ${headers})
# Every vector target is another compilation of the same file. Processors with SSSE3 have SSE4 since 2008.
set(SIGHTLINE_DISABLED_TARGETS "HWY_SSSE3" CACHE STRING "Highway's targets to leave out, as an expression")
target_compile_definitions(sightline_dependencies INTERFACE HWY_DISABLED_TARGETS=${SIGHTLINE_DISABLED_TARGETS})
# Below SSE4 one lane serves, with clang as with g++: four emulated ones take clang's sanitizers minutes a source.
target_compile_definitions(sightline_dependencies INTERFACE HWY_BROKEN_EMU128=1)
# On ARM, g++ inlines nothing into lambdas where Highway raises the instruction set for a part of a source: NEON is all
# that the library wants, and the baseline has it.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  target_compile_definitions(sightline_dependencies INTERFACE HWY_COMPILE_ONLY_STATIC TOOLCHAIN_MISS_SYS_AUXV_H)
endif()
