// SPDX-License-Identifier: MIT
// Reads and checks the configuration a caller hands in.
#include "drivers/geometric/config.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

void unisim_geometric_config_init(unisim_geometric_config* config, size_t struct_size) {
  if (config == nullptr) return;
  unisim_geometric_config defaults{};
  defaults.struct_size = static_cast<uint32_t>(struct_size);
  defaults.max_tracks = 300;
  defaults.max_keyframes = 180;
  defaults.max_landmarks = 5000;
  defaults.max_window_views = 512;
  defaults.window_size = 16;
  defaults.adjust_every = 10;
  defaults.adjust_latency = 4;
  defaults.background = 1;
  defaults.revive_age = 100;
  defaults.revive_tries = 150;
  defaults.places = 1;
  defaults.loop_gap = 20;
  defaults.loop_tries = 3;
  defaults.min_pnp = 8;
  defaults.min_inliers = 20;
  defaults.min_share = 0.2;
  std::memcpy(config, &defaults, std::min(struct_size, sizeof(defaults)));
}

namespace unisim::geometric {

namespace {

constexpr double kMostReadoutMs = 200;

struct Range {
  const char* name;
  int32_t value;
  int32_t least;
  int32_t most;
};

/// A newer caller's fields, which this version does not know, are set.
bool has_unknown_tail(const unisim_geometric_config& in) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&in);
  for (size_t i = sizeof(in); i < in.struct_size; ++i) {
    if (bytes[i] != 0) return true;
  }
  return false;
}

/// What is wrong with what is said of the camera.
std::string camera_problem(const unisim_geometric_config& c) {
  const auto length = [](double value) { return std::isfinite(value) && value >= 0; };
  if (!length(c.focal_px) || !length(c.focal_y_px)) {
    return "focal_px must be a positive number of pixels, or 0 to estimate it; focal_y_px too";
  }
  if (!length(c.principal_x_px) || !length(c.principal_y_px) ||
      (c.principal_x_px > 0) != (c.principal_y_px > 0)) {
    return "principal_x_px and principal_y_px must be positive numbers of pixels, or both 0";
  }
  if (c.distortion_model < UNISIM_DISTORTION_UNKNOWN ||
      c.distortion_model > UNISIM_DISTORTION_FISHEYE) {
    return "distortion_model is " + std::to_string(c.distortion_model) + ", must be 0 to 2";
  }
  if (c.calibrated_width < 0 || c.calibrated_height < 0 ||
      (c.calibrated_width > 0) != (c.calibrated_height > 0)) {
    return "calibrated_width and calibrated_height must be the calibration's image size, or 0";
  }
  if (c.focal_px == 0 && (c.focal_y_px > 0 || c.distortion_model != UNISIM_DISTORTION_UNKNOWN)) {
    return "focal_y_px and distortion need focal_px: distortion is told in focal lengths";
  }
  if (c.shutter != UNISIM_SHUTTER_GLOBAL && c.shutter != UNISIM_SHUTTER_ROLLING) {
    return "shutter is " + std::to_string(c.shutter) + ", must be 0 or 1";
  }
  if (!(std::abs(c.readout_ms) <= kMostReadoutMs)) return "readout_ms must be -200 to 200";
  if (c.readout_ms != 0 && c.shutter != UNISIM_SHUTTER_ROLLING) {
    return "readout_ms is that of a rolling shutter: shutter must be 1";
  }
  for (int i = 0; i < UNISIM_DISTORTION_TERMS; ++i) {
    if (!std::isfinite(c.distortion[i])) return "a distortion term is not a number";
    const bool used = c.distortion_model == UNISIM_DISTORTION_PINHOLE ||
                      (c.distortion_model == UNISIM_DISTORTION_FISHEYE && i < 4);
    if (c.distortion[i] != 0 && !used) {
      return "distortion term " + std::to_string(i + 1) + " is none of distortion_model " +
             std::to_string(c.distortion_model);
    }
  }
  return {};
}

}  // namespace

std::string read_config(const unisim_geometric_config* in, unisim_geometric_config* out) {
  unisim_geometric_config_init(out, sizeof(*out));
  if (in == nullptr) return {};
  constexpr size_t kFirstRelease = offsetof(unisim_geometric_config, mask);
  if (in->struct_size < kFirstRelease || has_unknown_tail(*in)) {
    return "geometric: struct_size of the configuration is " + std::to_string(in->struct_size) +
           ", expected " + std::to_string(sizeof(*out)) + "; call unisim_geometric_config_init()";
  }
  std::memcpy(out, in, std::min<size_t>(in->struct_size, sizeof(*out)));
  out->struct_size = sizeof(*out);
  const Range ranges[] = {
      {"max_tracks", out->max_tracks, 50, 2000},
      {"max_keyframes", out->max_keyframes, 32, 4096},
      {"max_landmarks", out->max_landmarks, 4 * out->max_tracks, 1000000},
      {"max_window_views", out->max_window_views, UNISIM_MAX_VIEWS, 65536},
      {"window_size", out->window_size, 5, UNISIM_MAX_VIEWS},
      {"adjust_every", out->adjust_every, 0, 100000},
      {"adjust_latency", out->adjust_latency, 1, 1000},
      {"background", out->background, 0, 1},
      {"revive_age", out->revive_age, 0, 1000000},
      {"revive_tries", out->revive_tries, 0, out->max_tracks},
      {"places", out->places, 0, 1},
      {"loop_gap", out->loop_gap, 6, 100000},
      {"loop_tries", out->loop_tries, 0, 50},
      {"min_pnp", out->min_pnp, 6, 1000},
      {"min_inliers", out->min_inliers, 6, 1000},
  };
  for (const Range& range : ranges) {
    if (range.value >= range.least && range.value <= range.most) continue;
    return std::string("geometric: ") + range.name + " is " + std::to_string(range.value) +
           ", must be " + std::to_string(range.least) + " to " + std::to_string(range.most);
  }
  const std::string camera = camera_problem(*out);
  if (!camera.empty()) return "geometric: " + camera;
  if (!(out->min_share >= 0 && out->min_share <= 1)) {
    return "geometric: min_share must be 0 to 1";
  }
  const unisim_image& mask = out->mask;
  if (mask.data != nullptr && (mask.format != UNISIM_PIXEL_GRAY8 || mask.width < 1 ||
                               mask.height < 1 || mask.stride < mask.width)) {
    return "geometric: mask must be a GRAY8 image";
  }
  return {};
}

}  // namespace unisim::geometric
