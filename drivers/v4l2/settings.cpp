// SPDX-License-Identifier: MIT
// The configuration: defaults, checks.
#include "drivers/v4l2/settings.hpp"

#include <cstring>

#include "drivers/common/copy_out.hpp"
#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/pixel_formats.hpp"

namespace unisim::v4l2 {
namespace {

unisim_v4l2_config defaults() {
  unisim_v4l2_config config{};
  config.struct_size = sizeof config;
  config.width = 640;
  config.height = 480;
  config.buffers = 4;
  config.fps = 30;
  config.constant_rate = 1;
  config.focus_position = -1;
  config.frame_timeout_ms = 2000;
  config.reconnect_ms = 30000;
  return config;
}

void require(bool fine, const std::string& text) {
  if (!fine) throw DeviceError(UNISIM_V4L2_BAD_CONFIG, 0, "camera: " + text);
}

void require_range(const char* name, int64_t value, int64_t low, int64_t high) {
  require(value >= low && value <= high, std::string(name) + " is " + std::to_string(value) +
                                             ": give " + std::to_string(low) + " to " +
                                             std::to_string(high));
}

void check_numbers(const unisim_v4l2_config& config) {
  require_range("width", config.width, 1, 16384);
  require_range("height", config.height, 1, 16384);
  require_range("buffers", config.buffers, 3, 32);
  require(config.fps >= 1 && config.fps <= 1000, "fps must be 1 to 1000");
  require_range("exposure", config.exposure, UNISIM_V4L2_KEEP, UNISIM_V4L2_FIXED);
  require_range("exposure_us", config.exposure_us, 0, 100000000);
  require_range("constant_rate", config.constant_rate, 0, 1);
  require_range("focus", config.focus, UNISIM_V4L2_KEEP, UNISIM_V4L2_FIXED);
  require(config.focus_position >= -1, "focus_position must be -1 or more");
  const int32_t hz = config.power_line_hz;
  require(hz == 0 || hz == -1 || hz == 50 || hz == 60, "power_line_hz must be 50, 60, 0 or -1");
  require_range("frame_timeout_ms", config.frame_timeout_ms, 10, 600000);
  require_range("reconnect_ms", config.reconnect_ms, 0, 86400000);
}

}  // namespace

Settings check_settings(const unisim_v4l2_config* given) {
  Settings settings{defaults(), "", 0};
  if (given != nullptr) {
    require(given->struct_size >= sizeof(unisim_v4l2_config),
            "struct_size is " + std::to_string(given->struct_size) +
                ": call unisim_v4l2_config_init() first");
    std::memcpy(&settings.config, given, sizeof settings.config);
  }
  check_numbers(settings.config);
  if (settings.config.device != nullptr) settings.device = settings.config.device;
  const std::string format =
      settings.config.pixel_format != nullptr ? settings.config.pixel_format : "auto";
  if (format == "auto") return settings;
  for (const uint32_t fourcc : usable_formats()) {
    if (format == fourcc_text(fourcc)) settings.fourcc = fourcc;
  }
  require(settings.fourcc != 0,
          "pixel format '" + format + "' cannot be read: give auto, " + usable_formats_text());
  return settings;
}

}  // namespace unisim::v4l2

void unisim_v4l2_config_init(unisim_v4l2_config* config, size_t struct_size) {
  config->struct_size = static_cast<uint32_t>(struct_size);
  unisim::drivers::copy_out(unisim::v4l2::defaults(), config);
}
