// SPDX-License-Identifier: MIT
// A whole sequence: options in, folder out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tools/synth/camera.hpp"
#include "tools/synth/path.hpp"
#include "tools/synth/sequence_writer.hpp"

namespace unisim::synth {

struct SequenceOptions {
  std::string folder;
  std::string scene = "room";
  int frames = 300;
  int width = 640;
  int height = 480;
  int loops = -1;  ///< -1: 1, and 0 for the corridor
  uint64_t seed = 1;
  double focal_px = 0;  ///< 0: 0.82 x width
  double fps = 30;
  double radial_k1 = 0;
  bool blur = false;
  bool noise = false;
  bool exposure_jumps = false;
  bool jpeg = false;
  double readout_ms = 0;   ///< of a rolling shutter, first row to last; 0: all rows at once
  bool encode = false;     ///< depth and pose in the pixels; see encoding.hpp
  double unit_spread = 0;  ///< of encoded frames: 0 <= spread < 1
  bool force = false;
  int threads = 0;  ///< 0: one per processor core
};

/// What options ask of each other; the range of each is that of the command line.
/// @throws tools::Failure (2) naming the first option that makes no sense
void check_options(const SequenceOptions& options);

/// Camera and path that the options ask for.
Camera make_camera(const SequenceOptions& options);
CameraPath make_path(const SequenceOptions& options);

/// Time of a frame as it stands in the files: the middle of its exposure and of its readout.
double frame_time_s(const SequenceOptions& options, int frame);

/// Check, render and write. The bytes do not depend on the number of threads.
/// @param progress  called now and then, on the calling thread, with the number of frames done
/// @throws tools::Failure
void write_sequence(const SequenceOptions& options, const std::function<void(int)>& progress);

}  // namespace unisim::synth
