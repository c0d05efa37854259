# SPDX-License-Identifier: MIT
# For checks that build once more, of the sources in ROOT into FOLDER: by another compiler, for another machine; mostly the
# library alone.

# need_programs(PROGRAMS...): ends the check where one is not there, and says so.
macro(need_programs)
  foreach(program ${ARGN})
    find_program(found_${program} ${program})
    if(NOT found_${program})
      message("skipped: ${program} is not installed (tools/bootstrap.sh dev installs it)")
      return()
    endif()
  endforeach()
endmacro()

# configure_all(OPTIONS...): all but tests, with OPTIONS of CMake; ccache serves where it is there.
function(configure_all)
  find_program(ccache ccache)
  set(launcher "")
  if(ccache)
    set(launcher -DCMAKE_C_COMPILER_LAUNCHER=${ccache} -DCMAKE_CXX_COMPILER_LAUNCHER=${ccache})
  endif()
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${ROOT} -B ${FOLDER} ${ARGN} ${launcher} -DUNISIM_BUILD_TESTS=OFF
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# configure_library(OPTIONS...): the library alone. With -DCMAKE_UNITY_BUILD=ON, sources compiled several at once, it takes
# a fifth of the time.
function(configure_library)
  configure_all(${ARGN} -DUNISIM_BUILD_TOOLS=OFF -DUNISIM_DRIVER_REPLAY=OFF -DUNISIM_DRIVER_GEOMETRIC=OFF
    -DUNISIM_DRIVER_ONNX=OFF -DUNISIM_DRIVER_LCM=OFF)
endfunction()

# build_library(TARGETS...): of what was configured
function(build_library)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER} --target ${ARGN} --parallel 2
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# require_same_numbers(NAME COMMAND...): the probe run by COMMAND prints what HERE, that of this build, does.
function(require_same_numbers name)
  execute_process(COMMAND ${HERE} OUTPUT_VARIABLE here COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE there COMMAND_ERROR_IS_FATAL ANY)
  if(NOT here STREQUAL there)
    message(FATAL_ERROR "results differ: ${name} ${there} this build ${here}")
  endif()
  message("${name}: ${there}")
endfunction()
