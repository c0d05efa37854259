// SPDX-License-Identifier: MIT
// The command line of unisim-live.
#pragma once

#include <optional>
#include <string>

#include "drivers/v4l2/v4l2.h"
#include "tools/live/scheduling.hpp"
#include "tools/replay/options.hpp"

namespace unisim::live {

inline constexpr const char* kProgramName = "unisim-live";

/// What unisim-live has beside the options of a run.
struct Options {
  replay::Options run;        ///< out "": no results; sequence, format: of a recording played live
  std::string device;         ///< as given: camera, LCM or recording
  std::string image_channel;  ///< of LCM, "" for the usual one
  std::string odometry_channel;  ///< of LCM, "" for none
  bool list = false;
  bool as_camera = false;          ///< the recording plays a camera
  std::optional<std::string> web;  ///< where to serve the page: PORT or ADDRESS:PORT
  std::string web_token;
  bool record_images = true;  ///< with run.out: what a replay of this run needs
  std::string pixel_format = "auto";
  unisim_v4l2_config camera;  ///< its strings are those above
  Scheduling scheduling;
};

/// Whether `device` names a camera: a device file, its number, or nothing.
bool is_camera(const std::string& device);

inline constexpr const char* kLcmScheme = "lcm://";

/// Whether `device` names images that come over LCM.
bool is_lcm(const std::string& device);

/// Reads the command line. Throws Failure.
/// @return nothing when --help or --version has been answered
std::optional<Options> parse_options(int argc, const char* const* argv);

}  // namespace unisim::live
