// SPDX-License-Identifier: MIT
// The figures of a run: summary.json and the lines printed at the end.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "drivers/pipeline/pipeline.hpp"
#include "tools/common/json_text.hpp"
#include "tools/replay/options.hpp"
#include "tools/replay/run_data.hpp"
#include "tools/replay/scores.hpp"

namespace unisim::replay {

/// All there is to say about a run.
struct Run {
  const Options& options;
  const pipeline::Result& result;
  const RunData& data;
  const eval::Trajectory& truth;
  const Scores& scores;
  std::string format;  ///< as recognised
};

/// Keyframes with a pose over all keyframes; 0 without keyframes.
double coverage(const RunData& data);

/// "every 5" or "by motion".
std::string keyframe_choice(const Options& options);

/// Where the focal length comes from: "given", "estimated", "estimated +- 2.8 %".
std::string focal_source(const Run& run);

/// Most memory the process has held.
int64_t process_peak_bytes();

/// summary.json; a figure that is not known is null.
tools::Json summary_json(const Run& run);

/// A few lines for people.
/// @param files what was written
std::string summary_text(const Run& run, const std::vector<std::string>& files);

}  // namespace unisim::replay
