# SPDX-License-Identifier: MIT
# What every target of the project is compiled with. Flags are private: none is exported to users.

set(UNISIM_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)

# Without an operating system nothing is loaded elsewhere than it was linked for.
set(UNISIM_LIBRARIES_MOVE ON)
if(CMAKE_SYSTEM_NAME STREQUAL Generic)
  set(UNISIM_LIBRARIES_MOVE OFF)
endif()

# unisim_target_defaults(TARGET): language level, warnings, hidden visibility.
function(unisim_target_defaults target)
  target_compile_features(${target} PRIVATE cxx_std_17 c_std_99)
  target_compile_options(${target} PRIVATE ${UNISIM_WARNINGS})
  set_target_properties(${target} PROPERTIES
    CXX_EXTENSIONS OFF
    C_VISIBILITY_PRESET hidden
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ${UNISIM_LIBRARIES_MOVE})
endfunction()

# unisim_target_freestanding(TARGET): what core and capi add: no exceptions, no RTTI, nothing that
# would pull in libstdc++ at run time. No fused multiply-add, which some processors have and some not, and
# no sums of Eigen's whose order depends on the width of a register: results are the same bits everywhere.
function(unisim_target_freestanding target)
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno
    -ffp-contract=off>)
  target_compile_definitions(${target} PRIVATE EIGEN_NO_IO EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  # For one instruction set the library is kept small: -O3 makes it a third larger, most of it unrolled loops.
  if(NOT UNISIM_ISA STREQUAL "dispatch")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
    target_compile_definitions(${target} PRIVATE UNISIM_ONE_ISA)
    if(NOT UNISIM_ISA STREQUAL "default")
      target_compile_options(${target} PRIVATE -march=${UNISIM_ISA})
    endif()
  endif()
  # Whoever links the objects shares Eigen's inline functions with them.
  target_compile_definitions(${target} PUBLIC EIGEN_DONT_VECTORIZE)
endfunction()

# unisim_install_program(TARGET SAYS): into the folder of programs, with a manual page of its --help, headed by
# what it SAYS, where help2man is there. It finds libunisim beside that folder, wherever the two are moved together:
# no folder of libraries outside the system's is searched by itself.
function(unisim_install_program target says)
  file(RELATIVE_PATH to_libraries ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${to_libraries}")
  install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT unisim_tools)
  find_program(UNISIM_HELP2MAN help2man)
  # A program of another machine, or with a sanitizer's words in its output, is not asked.
  if(NOT UNISIM_HELP2MAN OR CMAKE_CROSSCOMPILING OR UNISIM_SANITIZE)
    return()
  endif()
  set(page ${PROJECT_BINARY_DIR}/man/${target}.1)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/man)
  add_custom_command(OUTPUT ${page}
    COMMAND ${UNISIM_HELP2MAN} --no-info --name ${says} --source "libunisim ${PROJECT_VERSION}"
      --version-string ${PROJECT_VERSION} --output ${page} $<TARGET_FILE:${target}>
    DEPENDS ${target} VERBATIM COMMENT "Making ${target}.1")
  add_custom_target(${target}-man ALL DEPENDS ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT unisim_tools)
endfunction()

# unisim_install_pkgconfig(NAME COMPONENT): cmake/NAME.pc.in, which finds its prefix from where it lies.
function(unisim_install_pkgconfig name component)
  file(RELATIVE_PATH UNISIM_PC_TO_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT ${component})
endfunction()

# unisim_vectorised_sources(TARGET ISAS FILES...): compiles sources of TARGET once more for each of ISAS, wider vectors of
# x86-64 (`avx2`, `avx512`), in a namespace of that name (core/base/isa.hpp). Which copy runs is decided at run time. Not
# with UNISIM_ISA for one instruction set.
function(unisim_vectorised_sources target isas)
  if(NOT UNISIM_ISA STREQUAL "dispatch")
    return()
  endif()
  set(flags_avx2 -mavx2)
  # What is not written for wide vectors is left with 256 bits.
  set(flags_avx512 -mavx2 -mavx512f -mavx512vl -mavx512dq -mprefer-vector-width=256)
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag("${flags_avx512}" UNISIM_COMPILER_HAS_WIDE_VECTORS)
  if(NOT UNISIM_COMPILER_HAS_WIDE_VECTORS)
    return()
  endif()
  foreach(isa IN LISTS isas)
    foreach(source IN LISTS ARGN)
      file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${source})
      set(copy ${CMAKE_CURRENT_BINARY_DIR}/${isa}/${source})
      file(CONFIGURE OUTPUT ${copy} CONTENT "#include \"${path}\"\n")
      set_source_files_properties(${copy} PROPERTIES
        COMPILE_OPTIONS "${flags_${isa}}" COMPILE_DEFINITIONS UNISIM_ISA=${isa})
      target_sources(${target} PRIVATE ${copy})
    endforeach()
  endforeach()
  target_compile_definitions(${target} PUBLIC UNISIM_HAS_WIDE_VECTORS)
endfunction()

# unisim_alone(SOURCES...): compiled one by one where all else is compiled several at once (CMAKE_UNITY_BUILD): their names
# are those of other sources beside them.
function(unisim_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# unisim_add_tests(LABEL LIBS...): one Catch2 program from all *.cpp of the calling folder, each test
# case registered with CTest under LABEL. A case that cannot run says WARN("skipped: why"). An exit code
# cannot say it: that of Catch2 2 is the number of failures.
function(unisim_add_tests label)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  # CTest would make two tests of such a name that run nothing and pass.
  foreach(source IN LISTS sources)
    file(STRINGS ${source} names REGEX "TEST_CASE\\(\"[^\"]*;")
    if(names)
      message(FATAL_ERROR "${source}: a name of a test has a semicolon: ${names}")
    endif()
  endforeach()
  add_executable(unisim-test-${label} ${sources})
  unisim_test_program(unisim-test-${label} "${label}: " ${label} ${ARGN})
endfunction()

# unisim_sanitize_lightly(TARGET): where most is Eigen, each access of an element asks whether its reference is null and
# aligned: half of what it takes to compile and to run. A null pointer is found without; the core keeps both.
function(unisim_sanitize_lightly target)
  if(UNISIM_SANITIZE)
    target_compile_options(${target} PRIVATE -fno-sanitize=null,alignment)
  endif()
endfunction()

# unisim_test_program(TARGET PREFIX LABEL LIBS...): the same for a program whose sources are there. Tests seldom take long,
# compiling them does: the headers of Catch2 and Eigen are read once for several files, and little is optimised.
function(unisim_test_program target prefix label)
  unisim_target_defaults(${target})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  unisim_sanitize_lightly(${target})
  target_link_libraries(${target} PRIVATE unisim_test_main ${ARGN})
  catch_discover_tests(${target} TEST_PREFIX "${prefix}"
    PROPERTIES LABELS ${label} SKIP_REGULAR_EXPRESSION "warning:[^a-z]+skipped: ")
endfunction()
