// SPDX-License-Identifier: MIT
// One run: a source, a predictor, results.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "tools/eval/trajectory.hpp"
#include "tools/replay/inputs.hpp"
#include "tools/replay/options.hpp"
#include "tools/replay/progress_line.hpp"

namespace unisim::replay {

/// What a run reads.
struct Input {
  SourcePtr source;
  eval::Trajectory truth;                      ///< without poses: none
  std::optional<FrameSize> live_size;          ///< of a live camera's frames, where it is known
  std::vector<std::string> notes;              ///< told before the run
  std::vector<pipeline::Listener*> listeners;  ///< beside those of the results; borrowed
};

/// What differs between the programs that run.
struct Surroundings {
  std::function<Input()> open;  ///< called once the folder of results is ours; throws Failure
  ProgressLine::Text line;      ///< of the progress; empty: the usual one
  /// Before the first frame, with what will run; may be empty.
  std::function<void(const pipeline::Pipeline&, unisim_predictor*)> starts;
  std::function<void(const unisim_source*)> ended;  ///< after the last frame; may be empty
  pipeline::DistanceInbox* odometry = nullptr;  ///< what comes of it while the run goes; borrowed
};

/// Runs, writes the results where options.out names a folder, prints the summary. Throws Failure
/// before anything is computed.
/// @return exit code
int run(const Options& options, const Surroundings& around, const std::atomic<bool>& stop);

}  // namespace unisim::replay
