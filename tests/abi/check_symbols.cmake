# SPDX-License-Identifier: MIT
# Compare the dynamic symbols of LIBRARY with the list in EXPECTED.
execute_process(COMMAND ${NM} -D --defined-only ${LIBRARY} OUTPUT_VARIABLE listing
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL " [A-Za-z] [^\n]+" lines "${listing}")
set(found "")
foreach(line IN LISTS lines)
  if(line MATCHES "^ A ") # the version node itself
    continue()
  endif()
  string(REGEX REPLACE "^ [A-Za-z] ([^@]+).*$" "\\1" symbol "${line}")
  list(APPEND found ${symbol})
endforeach()
list(SORT found)
file(STRINGS ${EXPECTED} expected REGEX "^[a-z]")
list(SORT expected)
if(NOT found STREQUAL expected)
  message(FATAL_ERROR "exported: ${found}\nexpected: ${expected}\n"
    "A symbol that is new on purpose goes into unisim.symbols and into CHANGELOG.md.")
endif()
