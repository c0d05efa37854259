# SPDX-License-Identifier: MIT
# Build the library for a processor with no operating system, and list what it asks of whoever links it: no more than
# ALLOWED, a file with a symbol a line.
include(${CMAKE_CURRENT_LIST_DIR}/../support/library_alone.cmake)
need_programs(arm-none-eabi-g++ arm-none-eabi-nm arm-none-eabi-ld make)
configure_library(-G "Unix Makefiles" -Wno-dev -DCMAKE_TOOLCHAIN_FILE=${ROOT}/cmake/toolchains/bare_metal_arm.cmake
  -DEigen3_DIR=${EIGEN} -DCMAKE_BUILD_TYPE=MinSizeRel -DUNISIM_ISA=default)
build_library(unisim_static)

# All objects as one: what is left open is open for those who link it.
execute_process(COMMAND arm-none-eabi-ld -r --whole-archive ${FOLDER}/capi/libunisim.a -o ${FOLDER}/unisim.o
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND arm-none-eabi-nm --undefined-only --format=posix ${FOLDER}/unisim.o
  OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
list(TRANSFORM lines REPLACE " .*" "")
file(STRINGS ${ALLOWED} allowed REGEX "^[^#]")
set(refused ${lines})
list(REMOVE_ITEM refused ${allowed})
if(refused)
  message(FATAL_ERROR "without an operating system there is no ${refused}; ${ALLOWED} lists what there is")
endif()
set(gone ${allowed})
list(REMOVE_ITEM gone ${lines})
if(gone)
  message(FATAL_ERROR "no longer needed, take it out of ${ALLOWED}: ${gone}")
endif()
execute_process(COMMAND arm-none-eabi-size ${FOLDER}/unisim.o OUTPUT_VARIABLE size COMMAND_ERROR_IS_FATAL ANY)
message("needs ${lines}\n${size}")
