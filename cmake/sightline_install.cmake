# What is installed, in four components, which cpack makes four Debian packages of:
#   runtime    libsightline0     the shared library
#   dev        libsightline-dev  headers, both libraries to link, and what find_package and pkg-config look for
#   python     python3-sightline the Python module
#   workbench  sightline         the command line, and the workbench to build on
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/sightline)
set(components runtime dev)

set(targets sightline)
if(TARGET sightline_shared)
  list(APPEND targets sightline_shared)
endif()
install(TARGETS ${targets} EXPORT sightline_targets
        ARCHIVE COMPONENT dev
        LIBRARY COMPONENT runtime NAMELINK_COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/sightline DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" PATTERN workbench EXCLUDE)
install(EXPORT sightline_targets NAMESPACE sightline:: DESTINATION ${package_dir} COMPONENT dev)

# From <libdir>/pkgconfig up to the prefix, so that the installed tree can be moved.
file(RELATIVE_PATH SIGHTLINE_PC_UP /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
if(SIGHTLINE_PVS)
  set(SIGHTLINE_PC_PVS "-lroaring -lzstd")
endif()
configure_file(cmake/sightline.pc.in sightline.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sightline.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

configure_package_config_file(cmake/sightline-config.cmake.in sightline-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(sightline-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sightline-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/sightline-config-version.cmake
        DESTINATION ${package_dir} COMPONENT dev)

if(SIGHTLINE_WORKBENCH)
  list(APPEND components workbench)
  install(TARGETS sightline_app RUNTIME COMPONENT workbench)
  install(TARGETS sightline_workbench_archive EXPORT sightline_workbench_targets ARCHIVE COMPONENT workbench)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/sightline/workbench
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sightline COMPONENT workbench)
  install(EXPORT sightline_workbench_targets NAMESPACE sightline:: DESTINATION ${package_dir} COMPONENT workbench)
endif()
if(SIGHTLINE_PYTHON)
  list(APPEND components python)
  set(SIGHTLINE_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the Python module is installed")
  install(TARGETS sightline_python LIBRARY DESTINATION ${SIGHTLINE_PYTHON_DIR} COMPONENT python)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_VENDOR "Sightline")
set(CPACK_PACKAGE_CONTACT "The Sightline authors <sightline@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libsightline${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_GENERATE_SHLIBS ON)

set(exactly "libsightline${PROJECT_VERSION_MAJOR} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libsightline-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${exactly}, libhwy-dev")
if(SIGHTLINE_PVS)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libroaring-dev, libzstd-dev")
endif()

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sightline)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3-numpy")

set(CPACK_DEBIAN_WORKBENCH_PACKAGE_NAME sightline)
set(CPACK_DEBIAN_WORKBENCH_PACKAGE_SECTION graphics)
# Who builds on the workbench needs what stands below it.
set(CPACK_DEBIAN_WORKBENCH_PACKAGE_SUGGESTS
    "libsightline-dev (= ${PROJECT_VERSION}), libfmt-dev, libembree-dev, libtbb-dev, libzip-dev, libpng-dev, libopenmpi-dev, libmeshoptimizer-dev")
include(CPack)
