# SPDX-License-Identifier: MIT
# The dynamic section of LIBRARY: what it needs and what it is called.
execute_process(COMMAND ${READELF} -d ${LIBRARY} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "NEEDED[^\n]*\\[[^]]*\\]" needed "${dynamic}")
foreach(line IN LISTS needed)
  if(NOT line MATCHES "\\[lib[cm]\\.so|\\[ld-linux")
    message(FATAL_ERROR "the library needs more than libc and libm: ${line}")
  endif()
endforeach()
if(NOT dynamic MATCHES "SONAME[^\n]*\\[libunisim\\.so\\.[0-9]+(\\.[0-9]+)?\\]")
  message(FATAL_ERROR "no SONAME of the form libunisim.so.0.MINOR:\n${dynamic}")
endif()
