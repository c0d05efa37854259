# SPDX-License-Identifier: MIT
# Link SOURCE against LIBRARY with the C compiler and libm, run it, and look for C++ in it.
get_filename_component(folder ${LIBRARY} DIRECTORY)
execute_process(
  COMMAND ${CC} -std=c99 -I${INCLUDE} -I${BUILT_INCLUDE} ${SOURCE} ${LIBRARY}
    -Wl,-rpath,${folder} -lm -o ${PROGRAM}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${PROGRAM} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ldd ${PROGRAM} OUTPUT_VARIABLE needed COMMAND_ERROR_IS_FATAL ANY)
if(needed MATCHES "libstdc")
  message(FATAL_ERROR "a C program with ${LIBRARY} needs libstdc++:\n${needed}")
endif()
