// SPDX-License-Identifier: MIT
// Defaults of the configuration; part of every build, with ONNX Runtime or without.
#include <algorithm>
#include <cstring>

#include "drivers/onnx/onnx.h"

void unisim_onnx_config_init(unisim_onnx_config* config, size_t struct_size) {
  if (config == nullptr || struct_size < sizeof config->struct_size) return;
  unisim_onnx_config defaults{};
  defaults.struct_size = static_cast<uint32_t>(struct_size);
  defaults.window_size = 16;
  defaults.keyframe_interval = 5;
  defaults.min_pose_confidence = 0.75;
  std::memcpy(config, &defaults, std::min(struct_size, sizeof defaults));
}
