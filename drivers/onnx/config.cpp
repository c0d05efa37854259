// SPDX-License-Identifier: MIT
// Checks of the configuration.
#include "drivers/onnx/config.hpp"

#include <algorithm>
#include <cctype>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/memory_use.hpp"

namespace unisim::onnx {
namespace {

void require(bool good, const std::string& line) {
  if (!good) throw OnnxError(UNISIM_ONNX_BAD_CONFIG, "onnx." + line);
}

bool within(int32_t value, int32_t low, int32_t high) { return value >= low && value <= high; }

std::string text(const char* given, const char* otherwise) {
  return given != nullptr && *given != '\0' ? given : otherwise;
}

void require_size(const unisim_onnx_config& config) {
  require(config.struct_size == sizeof config,
          "struct_size is not that of this version; fill the struct with unisim_onnx_config_init");
}

}  // namespace

RunOptions read_run_options(const unisim_onnx_config& config) {
  require_size(config);
  require(within(config.threads, 0, 256), "threads must be 0 to 256");
  require(config.memory_mb >= 0, "memory_mb must be 0 or more");
  RunOptions run;
  run.provider = text(config.provider, "cpu");
  std::transform(run.provider.begin(), run.provider.end(), run.provider.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  run.library = text(config.library, "");
  run.threads = config.threads;
  run.memory_bytes =
      config.memory_mb > 0 ? int64_t{config.memory_mb} << 20 : machine_memory_bytes() / 2;
  return run;
}

Config read_config(const unisim_onnx_config& config) {
  Config read;
  read.run = read_run_options(config);
  require(within(config.window_size, 2, UNISIM_MAX_VIEWS),
          "window_size must be 2 to " + std::to_string(UNISIM_MAX_VIEWS));
  require(within(config.keyframe_interval, 1, 1000), "keyframe_interval must be 1 to 1000");
  require(config.min_pose_confidence >= 0 && config.min_pose_confidence <= 1,
          "min_pose_confidence must be 0 to 1");
  read.window_size = config.window_size;
  read.keyframe_interval = config.keyframe_interval;
  read.min_pose_confidence = config.min_pose_confidence;
  read.model_pair = text(config.model_pair, "");
  require(!read.model_pair.empty(), "model_pair is missing: give a model file");
  read.model_window = text(config.model_window, read.model_pair.c_str());
  read.model_encoder = text(config.model_encoder, "");
  return read;
}

}  // namespace unisim::onnx
