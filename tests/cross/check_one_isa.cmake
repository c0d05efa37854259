# SPDX-License-Identifier: MIT
# Build the library and the probe for one instruction set in FOLDER: no larger than MOST bytes when stripped, and the
# same bits as HERE, the probe of this build.
include(${CMAKE_CURRENT_LIST_DIR}/../support/library_alone.cmake)
configure_library(-DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release -DUNISIM_ISA=default)
build_library(unisim)

execute_process(COMMAND ${STRIP} -o ${FOLDER}/stripped.so ${FOLDER}/capi/libunisim.so COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${FOLDER}/stripped.so bytes)
if(bytes GREATER MOST)
  message(FATAL_ERROR "libunisim.so for one instruction set has ${bytes} bytes, at most ${MOST} are meant")
endif()

execute_process(
  COMMAND ${CC} -std=c99 -O1 -ffp-contract=off -I${ROOT}/capi/include -I${FOLDER}/capi/include
    ${ROOT}/tests/cross/probe.c -L${FOLDER}/capi -lunisim -lm -Wl,-rpath,${FOLDER}/capi -o ${FOLDER}/probe
  COMMAND_ERROR_IS_FATAL ANY)
require_same_numbers("${bytes} bytes" ${FOLDER}/probe)
