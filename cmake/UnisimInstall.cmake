# SPDX-License-Identifier: MIT
# Component unisim: what a program needs to run with libunisim. unisim_dev: what it takes to build one: headers, the
# static library, the CMake package, unisim.pc. Programs and drivers install themselves where they are built, as
# unisim_tools, unisim_drivers and unisim_drivers_dev.
include(CMakePackageConfigHelpers)

install(TARGETS unisim unisim_static EXPORT unisim-targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT unisim NAMELINK_COMPONENT unisim_dev
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT unisim_dev)
install(FILES
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/config.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/metric.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/places.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/results.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/snapshot.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/types.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/unisim.h
  ${PROJECT_BINARY_DIR}/capi/include/unisim/version.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/unisim COMPONENT unisim_dev)

set(unisim_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/unisim)
install(EXPORT unisim-targets NAMESPACE unisim:: DESTINATION ${unisim_package_dir}
  COMPONENT unisim_dev)
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/unisim-config.cmake.in ${PROJECT_BINARY_DIR}/unisim-config.cmake
  INSTALL_DESTINATION ${unisim_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/unisim-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/unisim-config.cmake ${PROJECT_BINARY_DIR}/unisim-config-version.cmake
  DESTINATION ${unisim_package_dir} COMPONENT unisim_dev)

unisim_install_pkgconfig(unisim unisim_dev)
