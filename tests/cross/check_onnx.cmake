# SPDX-License-Identifier: MIT
# Builds the ONNX driver and onnx_probe.cpp for aarch64 and runs them under qemu-aarch64-static.
foreach(part COMPILER EMULATOR RUNTIME)
  if(NOT EXISTS "${${part}}")
    message(STATUS "skipped: no ${part} (${${part}}); install g++-aarch64-linux-gnu and qemu-user-static, "
                   "run tools/fetch_onnxruntime.sh 1.21.0 aarch64")
    return()
  endif()
endforeach()

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} -S ${ROOT} -B ${BUILD} --preset arm64)
run(${CMAKE_COMMAND} --build ${BUILD} --parallel 2 --target unisim_driver_onnx)
run(${COMPILER} -std=c++17 -O2 -I${ROOT} -I${ROOT}/capi/include -I${BUILD}/capi/include
    ${ROOT}/tests/cross/onnx_probe.cpp ${BUILD}/drivers/onnx/libunisim_driver_onnx.a -ldl
    -o ${BUILD}/onnx_probe)
run(${EMULATOR} -L /usr/aarch64-linux-gnu ${BUILD}/onnx_probe ${ROOT}/tests/onnx/models ${RUNTIME})
message(STATUS "${output}")
