# SPDX-License-Identifier: MIT
# What every target of the project is compiled with. Flags are private: none is exported to users.

set(UNISIM_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)

# unisim_target_defaults(TARGET): language level, warnings, hidden visibility.
function(unisim_target_defaults target)
  target_compile_features(${target} PRIVATE cxx_std_17 c_std_99)
  target_compile_options(${target} PRIVATE ${UNISIM_WARNINGS})
  set_target_properties(${target} PROPERTIES
    CXX_EXTENSIONS OFF
    C_VISIBILITY_PRESET hidden
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON)
endfunction()

# unisim_target_freestanding(TARGET): what core and capi add: no exceptions, no RTTI, nothing that
# would pull in libstdc++ at run time.
function(unisim_target_freestanding target)
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno>)
  target_compile_definitions(${target} PRIVATE EIGEN_NO_IO EIGEN_MAX_STATIC_ALIGN_BYTES=16)
endfunction()

# unisim_add_tests(LABEL LIBS...): one Catch2 program from all *.cpp of the calling folder, each test
# case registered with CTest under LABEL.
function(unisim_add_tests label)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_executable(unisim-test-${label} ${sources})
  unisim_target_defaults(unisim-test-${label})
  target_link_libraries(unisim-test-${label} PRIVATE unisim_test_main ${ARGN})
  catch_discover_tests(unisim-test-${label} TEST_PREFIX "${label}: "
    PROPERTIES LABELS ${label} SKIP_RETURN_CODE 4)
endfunction()
