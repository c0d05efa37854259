# SPDX-License-Identifier: MIT
# Build the library with clang in FOLDER: it compiles without a warning, needs libc and libm alone, calls no
# heap, a C program links it without libstdc++, and its numbers are those of HERE, the probe in this build.
# Not optimised: what an optimiser would leave out counts.
find_program(clang clang)
find_program(clangxx clang++)
if(NOT clang OR NOT clangxx)
  message("skipped: clang is not installed (tools/bootstrap.sh dev installs it)")
  return()
endif()
find_program(ccache ccache)
set(launcher "")
if(ccache)
  set(launcher -DCMAKE_C_COMPILER_LAUNCHER=${ccache} -DCMAKE_CXX_COMPILER_LAUNCHER=${ccache})
endif()

execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${ROOT} -B ${FOLDER} -DCMAKE_C_COMPILER=${clang}
    -DCMAKE_CXX_COMPILER=${clangxx} -DCMAKE_BUILD_TYPE=Debug -DEigen3_DIR=${EIGEN} ${launcher}
    -DUNISIM_BUILD_TESTS=OFF -DUNISIM_BUILD_TOOLS=OFF -DUNISIM_DRIVER_REPLAY=OFF
    -DUNISIM_DRIVER_GEOMETRIC=OFF -DUNISIM_DRIVER_ONNX=OFF
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
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
  execute_process(COMMAND ${FOLDER}/${name} OUTPUT_VARIABLE there COMMAND_ERROR_IS_FATAL ANY)
  set(LIBRARY ${FOLDER}/${name})
  include(${CMAKE_CURRENT_LIST_DIR}/check_needed.cmake)
endforeach()
execute_process(COMMAND ${HERE} OUTPUT_VARIABLE here COMMAND_ERROR_IS_FATAL ANY)
if(NOT here STREQUAL there)
  message(FATAL_ERROR "results differ: clang ${there} this build ${here}")
endif()
