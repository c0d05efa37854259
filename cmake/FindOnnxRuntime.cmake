# SPDX-License-Identifier: MIT
# Finds the C header of ONNX Runtime; the library itself is opened at run time.
#
# Looks in ONNXRUNTIME_ROOT (variable or environment), where tools/bootstrap.sh puts it, then where systems
# do. Sets OnnxRuntime_FOUND, OnnxRuntime_INCLUDE_DIR, OnnxRuntime_API_VERSION; target OnnxRuntime::Headers.
if(NOT ONNXRUNTIME_ROOT AND DEFINED ENV{ONNXRUNTIME_ROOT})
  set(ONNXRUNTIME_ROOT $ENV{ONNXRUNTIME_ROOT})
endif()
if(ONNXRUNTIME_ROOT AND NOT IS_DIRECTORY ${ONNXRUNTIME_ROOT})
  message(FATAL_ERROR "ONNXRUNTIME_ROOT is no folder: ${ONNXRUNTIME_ROOT}; correct or unset it")
endif()
# The header is the same on every architecture, so that a cross build takes the host's.
find_path(OnnxRuntime_INCLUDE_DIR onnxruntime_c_api.h
  HINTS ${ONNXRUNTIME_ROOT} ${PROJECT_SOURCE_DIR}/build/onnxruntime
  PATH_SUFFIXES include include/onnxruntime include/onnxruntime/core/session headers onnxruntime
  NO_CMAKE_FIND_ROOT_PATH)
if(OnnxRuntime_INCLUDE_DIR)
  file(STRINGS ${OnnxRuntime_INCLUDE_DIR}/onnxruntime_c_api.h line REGEX "#define ORT_API_VERSION ")
  string(REGEX REPLACE ".*ORT_API_VERSION ([0-9]+).*" "\\1" OnnxRuntime_API_VERSION "${line}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OnnxRuntime REQUIRED_VARS OnnxRuntime_INCLUDE_DIR)
mark_as_advanced(OnnxRuntime_INCLUDE_DIR)
if(OnnxRuntime_FOUND AND NOT TARGET OnnxRuntime::Headers)
  add_library(OnnxRuntime::Headers INTERFACE IMPORTED GLOBAL)
  set_target_properties(OnnxRuntime::Headers PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${OnnxRuntime_INCLUDE_DIR})
endif()
