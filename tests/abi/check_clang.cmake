# SPDX-License-Identifier: MIT
# Build the library with clang in FOLDER: it compiles without a warning, needs libc and libm alone, calls no
# heap, a C program links it without libstdc++, and its numbers are those of HERE, the probe in this build.
# Not optimised: what an optimiser would leave out counts.
include(${CMAKE_CURRENT_LIST_DIR}/../support/library_alone.cmake)
need_programs(clang clang++)
configure_library(-DCMAKE_C_COMPILER=${found_clang} -DCMAKE_CXX_COMPILER=${found_clang++} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_UNITY_BUILD=ON
  -DEigen3_DIR=${EIGEN})
execute_process(
  COMMAND ${CMAKE_COMMAND} --build ${FOLDER} --target unisim unisim_static --parallel 2
  OUTPUT_VARIABLE out ERROR_VARIABLE out RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "clang does not build the library:\n${out}")
endif()

set(ARCHIVE ${FOLDER}/capi/libunisim.a)
include(${CMAKE_CURRENT_LIST_DIR}/check_no_heap.cmake)
set(LIBRARY ${FOLDER}/capi/libunisim.so)
include(${CMAKE_CURRENT_LIST_DIR}/check_needed.cmake)

set(includes -I${ROOT}/capi/include -I${FOLDER}/capi/include)
foreach(source capi/examples/small_loop.c tests/cross/probe.c)
  get_filename_component(name ${source} NAME_WE)
  execute_process(
    COMMAND ${CC} -std=c99 -ffp-contract=off ${includes} ${ROOT}/${source} ${ARCHIVE} -lm
      -o ${FOLDER}/${name}
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${FOLDER}/${name} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  set(LIBRARY ${FOLDER}/${name})
  include(${CMAKE_CURRENT_LIST_DIR}/check_needed.cmake)
endforeach()
require_same_numbers(clang ${FOLDER}/probe)
