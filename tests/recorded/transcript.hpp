// SPDX-License-Identifier: MIT
// Runs a predictor as the pipeline does and writes down every answer, byte for byte.
#pragma once

#include <string>
#include <vector>

#include "drivers/predictor.h"

namespace unisim::test {

struct RunOptions {
  int frames = 24;
  int stride = 2;       ///< every stride-th frame is a keyframe
  int first_frame = 0;  ///< index of the first
  int window = 3;       ///< keyframes; a window at each keyframe from there on
};

/// What a run saw. Values are hexadecimal floats, so equal lines are equal bits.
struct Transcript {
  std::vector<std::string>
      answers;  ///< of two_view, multi_view, next_revision, next_wide_window, ...
  std::vector<std::string> messages;  ///< of REJECTED and FAILED
  std::vector<int> advice;            ///< keyframe_advice of each frame
  int failed = 0;                     ///< calls that said FAILED
};

Transcript run_predictor(unisim_predictor* predictor, const RunOptions& options = {});

/// A fresh folder, removed with all it holds at the end of its life.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

std::string read_bytes(const std::string& path);
void write_bytes(const std::string& path, const std::string& bytes);

/// Records the scripted predictor's run into `path`. @return what was seen through the recorder
Transcript record_scripted(const std::string& path, const RunOptions& options = {});

}  // namespace unisim::test
