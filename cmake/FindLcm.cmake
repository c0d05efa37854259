# SPDX-License-Identifier: MIT
# Finds LCM: library, headers and lcm-gen. By their names, because Debian's lcm.pc needs the headers of
# GLib, which nothing here does. Looks in Lcm_ROOT, CMAKE_PREFIX_PATH (for the wheel of PyPI: its
# site-packages) and where systems have it. Sets Lcm_FOUND; targets Lcm::lcm, Lcm::gen.
find_path(Lcm_INCLUDE_DIR lcm/lcm.h)
find_library(Lcm_LIBRARY lcm)
# A program of the building machine, also in a cross build.
find_program(Lcm_GEN lcm-gen NO_CMAKE_FIND_ROOT_PATH)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Lcm REQUIRED_VARS Lcm_LIBRARY Lcm_INCLUDE_DIR Lcm_GEN)
mark_as_advanced(Lcm_INCLUDE_DIR Lcm_LIBRARY Lcm_GEN)
if(Lcm_FOUND AND NOT TARGET Lcm::lcm)
  add_library(Lcm::lcm UNKNOWN IMPORTED GLOBAL)
  set_target_properties(Lcm::lcm PROPERTIES
    IMPORTED_LOCATION ${Lcm_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${Lcm_INCLUDE_DIR})
  add_executable(Lcm::gen IMPORTED GLOBAL)
  set_target_properties(Lcm::gen PROPERTIES IMPORTED_LOCATION ${Lcm_GEN})
endif()
