# SPDX-License-Identifier: MIT
# Build the library and the probe for one instruction set in FOLDER: no larger than MOST bytes when stripped, and the
# same bits as HERE, the probe of this build.
find_program(ccache ccache)
set(launcher "")
if(ccache)
  set(launcher -DCMAKE_C_COMPILER_LAUNCHER=${ccache} -DCMAKE_CXX_COMPILER_LAUNCHER=${ccache})
endif()
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${ROOT} -B ${FOLDER} -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_BUILD_TYPE=Release -DUNISIM_ISA=default ${launcher}
    -DUNISIM_BUILD_TESTS=OFF -DUNISIM_BUILD_TOOLS=OFF -DUNISIM_DRIVER_REPLAY=OFF
    -DUNISIM_DRIVER_GEOMETRIC=OFF -DUNISIM_DRIVER_ONNX=OFF -DUNISIM_DRIVER_LCM=OFF
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER} --target unisim --parallel 2
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

execute_process(COMMAND ${STRIP} -o ${FOLDER}/stripped.so ${FOLDER}/capi/libunisim.so COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${FOLDER}/stripped.so bytes)
if(bytes GREATER MOST)
  message(FATAL_ERROR "libunisim.so for one instruction set has ${bytes} bytes, at most ${MOST} are meant")
endif()

execute_process(
  COMMAND ${CC} -std=c99 -O1 -ffp-contract=off -I${ROOT}/capi/include -I${FOLDER}/capi/include
    ${ROOT}/tests/cross/probe.c -L${FOLDER}/capi -lunisim -lm -Wl,-rpath,${FOLDER}/capi -o ${FOLDER}/probe
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${HERE} OUTPUT_VARIABLE here COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${FOLDER}/probe OUTPUT_VARIABLE there COMMAND_ERROR_IS_FATAL ANY)
if(NOT here STREQUAL there)
  message(FATAL_ERROR "results differ: one instruction set ${there} this build ${here}")
endif()
message("${bytes} bytes: ${there}")
