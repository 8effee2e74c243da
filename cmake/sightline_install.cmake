# Installs the core: headers, library and a package that find_package(sightline) finds.
include(CMakePackageConfigHelpers)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/sightline DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
install(TARGETS sightline_core EXPORT sightline_targets)
if(SIGHTLINE_TOOLS)
  install(TARGETS sightline_app)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sightline)
install(EXPORT sightline_targets NAMESPACE sightline:: DESTINATION ${package_dir})
configure_package_config_file(cmake/sightline-config.cmake.in sightline-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(sightline-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sightline-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/sightline-config-version.cmake
        DESTINATION ${package_dir})
