# SPDX-License-Identifier: MIT
# No object of ARCHIVE may call the heap or C++'s run time library, whatever the paths it is called on.
execute_process(COMMAND ${NM} -A -u ${ARCHIVE} OUTPUT_VARIABLE undefined COMMAND_ERROR_IS_FATAL ANY)
set(heap "malloc|calloc|realloc|reallocarray|free|memalign|aligned_alloc|posix_memalign|strdup")
# _Zn, _Zd: operators new and delete. _ZSt, _ZNS, __cxa, __gxx: the library.
string(REGEX MATCHALL "[^\n]* U ((${heap})|(_Zn|_Zd|_ZSt|_ZNS|_ZNKS|__cxa|__gxx)[^\n]*)\n" found "${undefined}")
if(found)
  string(REPLACE ";" "" lines "${found}")
  message(FATAL_ERROR "objects of the library call the heap or libstdc++:\n${lines}")
endif()
