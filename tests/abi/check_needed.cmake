# SPDX-License-Identifier: MIT
# What LIBRARY, or a C program that holds it, needs at run time, and what a shared library is called.
execute_process(COMMAND ${READELF} -d ${LIBRARY} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "NEEDED[^\n]*\\[[^]]*\\]" needed "${dynamic}")
foreach(line IN LISTS needed)
  if(NOT line MATCHES "\\[lib[cm]\\.so|\\[ld-linux")
    message(FATAL_ERROR "${LIBRARY} needs more than libc and libm: ${line}")
  endif()
endforeach()
if(LIBRARY MATCHES "\\.so" AND NOT dynamic MATCHES "SONAME[^\n]*\\[libunisim\\.so\\.[0-9]+(\\.[0-9]+)?\\]")
  message(FATAL_ERROR "no SONAME of the form libunisim.so.0.MINOR:\n${dynamic}")
endif()
