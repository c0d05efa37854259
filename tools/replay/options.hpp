// SPDX-License-Identifier: MIT
// The command line of unisim-replay.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/replay/settings.hpp"

namespace unisim::replay {

inline constexpr const char* kProgramName = "unisim-replay";

struct FrameSize {
  int32_t width = 0;
  int32_t height = 0;
};

struct Options {
  const char* program = kProgramName;  ///< in messages
  std::string sequence;
  std::string out;
  std::string format = "auto";
  std::string predictor = "geometric";
  std::string predictions;  ///< file of --predictor recorded
  std::string record;       ///< file to write, "" for none
  std::string save_map;     ///< file for the map of the run, "" for none
  std::string load_map;     ///< map to go on with, "" for none
  bool localise = false;    ///< only look for frames in it
  std::string ground_truth;
  std::string odometry;                   ///< file of what an odometer said, "" for none
  double odometry_sigma = 0.02;           ///< standard deviation over the path
  std::optional<double> odometry_common;  ///< relative error that all of it shares
  std::string mask;              ///< image that hides what goes with the camera, "" for none
  std::string model_pair;        ///< files of --predictor onnx
  std::string model_window;      ///< the same where one model serves both
  std::string model_encoder;     ///< "": beside the models that need one
  std::string model_descriptor;  ///< "": places are told apart without a network
  std::string provider = "cpu";
  std::string onnx_runtime;        ///< library to open, "" to search
  std::optional<std::string> lcm;  ///< URL to publish on, "" for the usual one
  std::string lcm_image_channel;   ///< of an LCM event log that is read, "" for the usual one
  bool lcm_images = false;         ///< publish the frames too
  int32_t lcm_points = 0;          ///< publish so many points of each submap too
  int64_t from = 0;
  int64_t to = -1;  ///< -1: to the end
  bool force = false;
  bool quiet = false;
  bool json = false;
  bool report = true;
  bool print_config = false;
  bool list_frames = false;
  std::optional<FrameSize> live_size;  ///< of a live camera's frames, where it has said it
  Settings settings;                   ///< defaults, then --config, then the options
};

/// Reads the command line and the configuration it names. Throws Failure.
/// @return nothing when --help or --version has been answered
std::optional<Options> parse_options(int argc, const char* const* argv);

}  // namespace unisim::replay
