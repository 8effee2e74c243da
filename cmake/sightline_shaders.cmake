# sightline_shaders(TARGET FILES...): GLSL to SPIR-V by glslc, as C arrays that sources of the target include as
# "shaders/NAME.STAGE.inc". Includes are resolved from the root, as in C++: structs that both share are written once.
find_program(SIGHTLINE_GLSLC glslc)

function(sightline_shaders target)
  if(NOT SIGHTLINE_GLSLC)
    message(FATAL_ERROR "glslc is not installed, expected package glslc")
  endif()
  set(out ${CMAKE_CURRENT_BINARY_DIR}/embedded/shaders)
  file(MAKE_DIRECTORY ${out})
  if(SIGHTLINE_MUTANTS)
    set(mutants -DSIGHTLINE_MUTANTS -I ${PROJECT_BINARY_DIR}/mutants)
  endif()
  foreach(file IN LISTS ARGN)
    get_filename_component(name ${file} NAME)
    # -w: glslang 12 warns of `invariant` without naming a fault.
    add_custom_command(
      OUTPUT ${out}/${name}.inc
      COMMAND ${SIGHTLINE_GLSLC} -O -w --target-env=vulkan1.3 -mfmt=c -MD -MF ${out}/${name}.d
              -I ${PROJECT_SOURCE_DIR} ${mutants} -o ${out}/${name}.inc ${CMAKE_CURRENT_SOURCE_DIR}/${file}
      DEPENDS ${file}
      DEPFILE ${out}/${name}.d
      VERBATIM)
    list(APPEND embedded ${out}/${name}.inc)
  endforeach()
  target_sources(${target} PRIVATE ${embedded})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/embedded)
endfunction()
