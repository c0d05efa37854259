# SPDX-License-Identifier: MIT
# Which layer may include what, and types that nobody may use. Run: cmake -DROOT=<repository> -P cmake/CheckLayers.cmake
#
#     tools --> drivers --> capi (unisim.h) --> core --> Eigen
#
# A driver may include what lies in its own folder, common/, the pipeline and the C headers beside the folders;
# outside packages only drivers and tools may see.

set(core_standard_headers
  algorithm array cmath cstddef cstdint cstring limits new type_traits utility)
set(capi_standard_headers ${core_standard_headers})
set(failures "")

# unisim_scan(FOLDER ALLOWED...): every include of the folder must match one of the expressions.
function(unisim_scan folder)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.hpp
    ${ROOT}/${folder}/*.c ${ROOT}/${folder}/*.cpp)
  set(found "")
  foreach(file IN LISTS files)
    file(STRINGS ${ROOT}/${file} lines REGEX "^[ \t]*#[ \t]*include")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]*)[>\"].*" "\\1" header "${line}")
      set(allowed FALSE)
      foreach(expression IN LISTS ARGN)
        if(header MATCHES "${expression}")
          set(allowed TRUE)
          break()
        endif()
      endforeach()
      if(NOT allowed)
        list(APPEND found "${file}: ${header}")
      endif()
    endforeach()
  endforeach()
  set(failures ${failures} ${found} PARENT_SCOPE)
endfunction()

# unisim_scan_forbidden(FOLDER FORBIDDEN...): no include of the folder may match one of these. Files that
# match the variable `exempt`, where it is set, are passed over.
function(unisim_scan_forbidden folder)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.hpp
    ${ROOT}/${folder}/*.c ${ROOT}/${folder}/*.cpp)
  if(exempt)
    list(FILTER files EXCLUDE REGEX "${exempt}")
  endif()
  set(found "")
  foreach(file IN LISTS files)
    file(STRINGS ${ROOT}/${file} lines REGEX "^[ \t]*#[ \t]*include")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]*)[>\"].*" "\\1" header "${line}")
      foreach(expression IN LISTS ARGN)
        if(header MATCHES "${expression}")
          list(APPEND found "${file}: ${header}")
        endif()
      endforeach()
    endforeach()
  endforeach()
  set(failures ${failures} ${found} PARENT_SCOPE)
endfunction()

list(JOIN core_standard_headers "|" core_standard)
list(JOIN capi_standard_headers "|" capi_standard)

# core and capi state all they may see.
unisim_scan(core "^core/" "^Eigen/" "^(${core_standard})$")
unisim_scan(capi/src "^capi/src/" "^core/(session|map/place_index)\\.hpp$" "^unisim/(places|unisim)\\.h$" "^(${capi_standard})$")
unisim_scan(capi/include "^unisim/(config|metric|places|results|snapshot|types|unisim|version)\\.h$" "^std(def|int)\\.h$")
unisim_scan(capi/examples "^unisim/unisim\\.h$" "^[a-z]+\\.h$")

# Above, only what is ours is restricted: the core is reached through unisim.h alone.
unisim_scan_forbidden(drivers "^core/" "^capi/" "^tools/" "^tests/")
# tools/bench is the exception: it measures the solver itself, on graphs no session would make.
file(GLOB tool_folders RELATIVE ${ROOT} ${ROOT}/tools/*)
list(REMOVE_ITEM tool_folders tools/bench)
foreach(folder IN LISTS tool_folders)
  unisim_scan_forbidden(${folder} "^core/" "^capi/" "^tests/")
endforeach()
unisim_scan_forbidden(tools/bench "^core/(map|session)" "^capi/" "^tests/")

# The C headers of drivers are plain C.
file(GLOB driver_headers RELATIVE ${ROOT} ${ROOT}/drivers/*.h ${ROOT}/drivers/*/*.h)
foreach(header IN LISTS driver_headers)
  file(STRINGS ${ROOT}/${header} lines REGEX "^[ \t]*#[ \t]*include[ \t]*<c[a-z]+>|^namespace|^class ")
  foreach(line IN LISTS lines)
    list(APPEND failures "${header}: ${line}")
  endforeach()
endforeach()

# On 32-bit Arm a long double is a double: what needs its digits there loses them.
foreach(folder core capi drivers tools)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp)
  foreach(file IN LISTS files)
    file(STRINGS ${ROOT}/${file} lines REGEX "long double|strtold")
    foreach(line IN LISTS lines)
      list(APPEND failures "${file}: ${line}")
    endforeach()
  endforeach()
endforeach()

# Tests of these folders see unisim.h only.
foreach(folder alloc fuzz)
  unisim_scan_forbidden(tests/${folder} "^core/" "^drivers/" "^tools/")
endforeach()

if(failures)
  list(JOIN failures "\n  " text)
  message(FATAL_ERROR "includes that cross a layer, or types that differ between machines:\n  ${text}")
endif()
