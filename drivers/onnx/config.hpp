// SPDX-License-Identifier: MIT
// The configuration as this driver keeps it: checked, strings owned.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/onnx/onnx.h"

namespace unisim::onnx {

/// How a network is run; see unisim_onnx_config.
struct RunOptions {
  std::string provider;
  std::string library;
  int32_t threads = 0;
  int64_t memory_bytes = 0;  ///< > 0
};

struct Config {
  RunOptions run;
  int32_t window_size = 0;
  int32_t keyframe_interval = 0;
  double min_pose_confidence = 0;
  std::string model_pair;
  std::string model_window;   ///< the same path as model_pair where one model serves both
  std::string model_encoder;  ///< "": beside the models that need one
};

/// @throws OnnxError (UNISIM_ONNX_BAD_CONFIG) naming the first field that makes no sense
RunOptions read_run_options(const unisim_onnx_config& config);
Config read_config(const unisim_onnx_config& config);

}  // namespace unisim::onnx
