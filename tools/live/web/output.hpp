// SPDX-License-Identifier: MIT
// --web: a page on the robot that shows the run as it goes.
#pragma once

#include <memory>
#include <string>

#include "drivers/pipeline/pipeline.hpp"
#include "tools/live/options.hpp"
#include "tools/live/pose_age.hpp"

namespace unisim::live::web {

/// Nothing where --web is not given.
class Output {
 public:
  /// Begins to serve. Throws Failure: a wrong option, or not in this build (2); the port is taken
  /// (4).
  /// @param ages borrowed
  Output(const Options& options, const PoseAge* ages);
  /// Stops serving.
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// NULL without --web.
  pipeline::Listener* listener();
  /// One line: where the page is; "" without --web.
  std::string note() const;
  /// Before the first frame.
  void attach(const pipeline::Pipeline& pipeline, unisim_predictor* predictor);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace unisim::live::web
