// SPDX-License-Identifier: MIT
// The configuration, checked and copied.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {

struct Settings {
  unisim_v4l2_config config;  ///< numbers; its strings are those below
  std::string device;         ///< "": the first camera
  uint32_t fourcc = 0;        ///< 0: any
};

/// @throws DeviceError with UNISIM_V4L2_BAD_CONFIG
Settings check_settings(const unisim_v4l2_config* given);

}  // namespace unisim::v4l2
