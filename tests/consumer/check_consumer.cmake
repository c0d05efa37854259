# SPDX-License-Identifier: MIT
# Install the library of BUILD into a fresh prefix, move it elsewhere, and build and run the user's project in C
# against it. USES is find_package or pkg-config. DRIVERS_EXAMPLE, where the second library was built, is a program for it.
file(REMOVE_RECURSE ${WORK})
set(components unisim unisim_dev)
if(DRIVERS_EXAMPLE)
  list(APPEND components unisim_drivers unisim_drivers_dev)
endif()
foreach(component IN LISTS components)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component ${component} --prefix ${WORK}/first
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME ${WORK}/first ${WORK}/moved)

set(ENV{PKG_CONFIG_PATH} ${WORK}/moved/${LIBDIR}/pkgconfig)
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${PROJECT} -B ${WORK}/build -G ${GENERATOR}
    -DCMAKE_C_COMPILER=${CC} -DCMAKE_BUILD_TYPE=Release -DCONSUMER_USES=${USES}
    -DCMAKE_PREFIX_PATH=${WORK}/moved -DDRIVERS_EXAMPLE=${DRIVERS_EXAMPLE}
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build COMMAND_ERROR_IS_FATAL ANY)

set(ENV{LD_LIBRARY_PATH} ${WORK}/moved/${LIBDIR})
file(GLOB programs ${WORK}/build/consumer_*)
foreach(program IN LISTS programs)
  execute_process(COMMAND ${program} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ldd ${program} OUTPUT_VARIABLE needed COMMAND_ERROR_IS_FATAL ANY)
  if(needed MATCHES "libstdc")
    message(FATAL_ERROR "${program} needs libstdc++")
  endif()
endforeach()

if(DRIVERS_EXAMPLE)
  execute_process(COMMAND ${WORK}/build/drivers_consumer COMMAND_ERROR_IS_FATAL ANY)
endif()

file(GLOB_RECURSE texts ${WORK}/moved/*.cmake ${WORK}/moved/*.pc)
foreach(text IN LISTS texts)
  file(READ ${text} content)
  string(FIND "${content}" "${WORK}/first" place)
  if(NOT place EQUAL -1)
    message(FATAL_ERROR "${text} names the folder it was installed to: it cannot be moved")
  endif()
endforeach()

# pkg-config --static, by hand as a Makefile would.
if(USES STREQUAL "pkg-config")
  execute_process(COMMAND pkg-config --static --cflags --libs unisim
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  list(TRANSFORM flags REPLACE "^-lunisim$" "-l:libunisim.a")
  execute_process(COMMAND ${CC} -std=c99 ${PROJECT}/main.c ${flags} -o ${WORK}/build/by_hand
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${WORK}/build/by_hand COMMAND_ERROR_IS_FATAL ANY)
endif()
file(REMOVE_RECURSE ${WORK})
