# SPDX-License-Identifier: MIT
# Build the library and the probe for MACHINE in FOLDER, run both probes, compare what they print.
include(${CMAKE_CURRENT_LIST_DIR}/../support/library_alone.cmake)
set(tools_arm64 aarch64-linux-gnu qemu-aarch64-static)
set(tools_armhf arm-linux-gnueabihf qemu-arm-static)
set(tools_riscv64 riscv64-linux-gnu qemu-riscv64-static)
list(GET tools_${MACHINE} 0 prefix)
list(GET tools_${MACHINE} 1 emulator)
need_programs(${prefix}-gcc ${prefix}-g++ ${emulator})

# Other optimisation than here: it may not change a bit either.
configure_library(-DCMAKE_TOOLCHAIN_FILE=${ROOT}/cmake/toolchains/${MACHINE}.cmake -DEigen3_DIR=${EIGEN}
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG")
build_library(unisim_static)
execute_process(
  COMMAND ${prefix}-gcc -std=c99 -O1 -ffp-contract=off -static -I${ROOT}/capi/include
    -I${FOLDER}/capi/include ${ROOT}/tests/cross/probe.c ${FOLDER}/capi/libunisim.a -lm
    -o ${FOLDER}/probe
  COMMAND_ERROR_IS_FATAL ANY)
require_same_numbers(${MACHINE} ${emulator} ${FOLDER}/probe)
