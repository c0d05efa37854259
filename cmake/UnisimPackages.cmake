# SPDX-License-Identifier: MIT
# Debian packages: `cpack -G DEB` in the folder of the build. For the folders of Debian configure it with
# -DCMAKE_INSTALL_PREFIX=/usr. What a package depends on is read from what it is linked to (dpkg-shlibdeps).
set(soname ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME libunisim)
set(CPACK_PACKAGE_CONTACT "libunisim contributors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Programs say of our libraries only their names: these are the packages that have them.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/capi ${PROJECT_BINARY_DIR}/drivers/library)
set(same "(= ${PROJECT_VERSION})")

# unisim_package(NAME SECTION DEPENDS SAYS COMPONENTS...)
macro(unisim_package name section depends says)
  string(TOUPPER ${name} key)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${key}_DESCRIPTION "${says}")
  foreach(component ${ARGN})
    string(TOUPPER ${component} upper)
    set(CPACK_COMPONENT_${upper}_GROUP ${name})
    list(APPEND CPACK_COMPONENTS_ALL ${component})
  endforeach()
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} RENAME copyright
    COMPONENT ${ARGV4})
endmacro()

set(CPACK_COMPONENTS_ALL "")
unisim_package(libunisim0 libs "" "Visual SLAM on Sim(3), C library with a fixed memory" unisim)
set(dev_needs "libunisim0 ${same}")
set(dev_parts unisim_dev)
if(TARGET unisim_drivers)
  unisim_package(libunisim-drivers0 libs "libunisim0 ${same}"
    "Cameras, recordings and predictors for libunisim, behind C headers" unisim_drivers)
  string(APPEND dev_needs ", libunisim-drivers0 ${same}")
  list(APPEND dev_parts unisim_drivers_dev)
endif()
unisim_package(libunisim-dev libdevel "${dev_needs}" "Headers, CMake and pkg-config files of libunisim" ${dev_parts})
if(UNISIM_BUILD_TOOLS)
  unisim_package(unisim-tools science "libunisim0 ${same}"
    "unisim-live, unisim-replay and the other programs of libunisim" unisim_tools)
endif()
include(CPack)
