# SPDX-License-Identifier: MIT
# unisim_python_with(OUT MODULES [CANDIDATES...]): the first interpreter that has the Python MODULES (comma-separated): of
# CANDIDATES, of the path, the system's. The one of the path may be without them. OUT is that one where none has.
function(unisim_python_with out modules)
  set(${out} ${Python3_EXECUTABLE} PARENT_SCOPE)
  foreach(candidate ${ARGN} ${Python3_EXECUTABLE} /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import ${modules}" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed EQUAL 0)
      set(${out} ${candidate} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()
