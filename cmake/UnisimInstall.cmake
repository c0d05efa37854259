# SPDX-License-Identifier: MIT
# Component unisim: libunisim (shared, static), its headers, the CMake package, unisim.pc.
# Programs and drivers install themselves where they are built.
include(CMakePackageConfigHelpers)

install(TARGETS unisim unisim_static EXPORT unisim-targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT unisim
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT unisim)
install(FILES
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/config.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/places.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/results.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/types.h
  ${PROJECT_SOURCE_DIR}/capi/include/unisim/unisim.h
  ${PROJECT_BINARY_DIR}/capi/include/unisim/version.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/unisim COMPONENT unisim)

set(unisim_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/unisim)
install(EXPORT unisim-targets NAMESPACE unisim:: DESTINATION ${unisim_package_dir}
  COMPONENT unisim)
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/unisim-config.cmake.in ${PROJECT_BINARY_DIR}/unisim-config.cmake
  INSTALL_DESTINATION ${unisim_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/unisim-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/unisim-config.cmake ${PROJECT_BINARY_DIR}/unisim-config-version.cmake
  DESTINATION ${unisim_package_dir} COMPONENT unisim)

file(RELATIVE_PATH UNISIM_PC_TO_PREFIX
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/unisim.pc.in ${PROJECT_BINARY_DIR}/unisim.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/unisim.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT unisim)
