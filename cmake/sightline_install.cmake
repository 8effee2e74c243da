# Installs the core: headers, library and a package that find_package(sightline) finds.
include(CMakePackageConfigHelpers)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/sightline DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" PATTERN workbench EXCLUDE)
install(TARGETS sightline sightline_c EXPORT sightline_targets)
install(FILES ${CMAKE_BINARY_DIR}/bindings/c/sightline.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
if(SIGHTLINE_WORKBENCH)
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

# cpack -G DEB: one package for who builds against the library and for who runs the command line.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME libsightline-dev)
set(CPACK_PACKAGE_VENDOR "Sightline")
set(CPACK_PACKAGE_CONTACT "The Sightline authors <sightline@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libhwy-dev")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
include(CPack)
