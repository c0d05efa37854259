// SPDX-License-Identifier: MIT
// Execution providers: on what a network runs.
#pragma once

#include <onnxruntime_c_api.h>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/runtime/runtime.hpp"

namespace unisim::onnx {

/// Adds the provider of `options` to the session's; "cpu" is there by itself.
/// @throws OnnxError (UNISIM_ONNX_NO_RUNTIME) when the library does not have it or refuses it
void append_provider(const Runtime& runtime, const RunOptions& options, OrtSessionOptions* session);

}  // namespace unisim::onnx
