// SPDX-License-Identifier: MIT
// What onnx.h says in a build without the header of ONNX Runtime.
#include <cstdio>

#include "drivers/onnx/onnx.h"

namespace {

void refuse(int32_t* problem, char* message, size_t capacity) {
  if (problem != nullptr) *problem = UNISIM_ONNX_NOT_BUILT;
  if (message == nullptr || capacity == 0) return;
  std::snprintf(message, capacity,
                "onnx: not in this build, which found no onnxruntime_c_api.h; run "
                "tools/bootstrap.sh build");
}

}  // namespace

unisim_predictor* unisim_onnx_create(const unisim_onnx_config*, int32_t* problem, char* message,
                                     size_t capacity) {
  refuse(problem, message, capacity);
  return nullptr;
}

int32_t unisim_onnx_window_size(const unisim_predictor*) { return 0; }

const char* unisim_onnx_note(const unisim_predictor*, int32_t) { return nullptr; }

int64_t unisim_onnx_encoder_runs(const unisim_predictor*) { return 0; }

int64_t unisim_onnx_peak_before_bytes() { return 0; }

unisim_onnx_descriptor* unisim_onnx_descriptor_open(const unisim_onnx_config*, const char*,
                                                    int32_t* problem, char* message,
                                                    size_t capacity) {
  refuse(problem, message, capacity);
  return nullptr;
}

int32_t unisim_onnx_descriptor_size(const unisim_onnx_descriptor*) { return 0; }

int unisim_onnx_descriptor_embed(unisim_onnx_descriptor*, const unisim_image*, const float**) {
  return UNISIM_PREDICTION_FAILED;
}

const char* unisim_onnx_descriptor_message(const unisim_onnx_descriptor*) { return ""; }

void unisim_onnx_descriptor_close(unisim_onnx_descriptor*) {}
