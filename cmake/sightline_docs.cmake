# The target `docs`: the API reference as HTML in BUILD/docs/html, where doxygen is installed. A reference to what is not
# there, or a parameter that does not exist, is an error.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  add_custom_target(docs
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/docs
    COMMAND ${CMAKE_COMMAND} -E env SIGHTLINE_DOCS=${CMAKE_BINARY_DIR}/docs $<TARGET_FILE:Doxygen::doxygen> docs/Doxyfile
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
endif()
