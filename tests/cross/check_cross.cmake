# SPDX-License-Identifier: MIT
# Build the library and the probe for MACHINE in FOLDER, run both probes, compare what they print.
set(tools_arm64 aarch64-linux-gnu qemu-aarch64-static)
set(tools_armhf arm-linux-gnueabihf qemu-arm-static)
set(tools_riscv64 riscv64-linux-gnu qemu-riscv64-static)
list(GET tools_${MACHINE} 0 prefix)
list(GET tools_${MACHINE} 1 emulator)

foreach(program ${prefix}-gcc ${prefix}-g++ ${emulator})
  find_program(found_${program} ${program})
  if(NOT found_${program})
    message("skipped: ${program} is not installed (tools/bootstrap.sh dev installs it)")
    return()
  endif()
endforeach()
find_program(ccache ccache)
set(launcher "")
if(ccache)
  set(launcher -DCMAKE_C_COMPILER_LAUNCHER=${ccache} -DCMAKE_CXX_COMPILER_LAUNCHER=${ccache})
endif()

# Other optimisation than here: it may not change a bit either.
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${ROOT} -B ${FOLDER}
    -DCMAKE_TOOLCHAIN_FILE=${ROOT}/cmake/toolchains/${MACHINE}.cmake -DEigen3_DIR=${EIGEN}
    -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG" ${launcher}
    -DUNISIM_BUILD_TESTS=OFF -DUNISIM_BUILD_TOOLS=OFF -DUNISIM_DRIVER_REPLAY=OFF
    -DUNISIM_DRIVER_GEOMETRIC=OFF -DUNISIM_DRIVER_ONNX=OFF
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${CMAKE_COMMAND} --build ${FOLDER} --target unisim_static --parallel 2
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(
  COMMAND ${prefix}-gcc -std=c99 -O1 -ffp-contract=off -static -I${ROOT}/capi/include
    -I${FOLDER}/capi/include ${ROOT}/tests/cross/probe.c ${FOLDER}/capi/libunisim.a -lm
    -o ${FOLDER}/probe
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${HERE} OUTPUT_VARIABLE here COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${emulator} ${FOLDER}/probe OUTPUT_VARIABLE there COMMAND_ERROR_IS_FATAL ANY)
if(NOT here STREQUAL there)
  message(FATAL_ERROR "results differ: ${MACHINE} ${there} this machine ${here}")
endif()
message("${MACHINE}: ${there}")
