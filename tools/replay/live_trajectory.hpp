// SPDX-License-Identifier: MIT
// trajectory_live.tum: grows as the run goes on and can be read at any time.
#pragma once

#include <string>

#include "drivers/pipeline/listener.hpp"

namespace unisim::replay {

/// Made with the first pose. A pose is with the system when it has been given out: it is there
/// however the process ends. Poses keep the map's unit, which can be read into metres at any time:
/// a comment says how long it is where that becomes known or changes.
class LiveTrajectory : public pipeline::Listener {
 public:
  explicit LiveTrajectory(std::string path) : path_(std::move(path)) {}
  ~LiveTrajectory() override;
  LiveTrajectory(const LiveTrajectory&) = delete;
  LiveTrajectory& operator=(const LiveTrajectory&) = delete;

  void on_live_pose(const pipeline::LivePose& pose) override;

  const std::string& path() const { return path_; }
  /// Why poses are missing, "" if none are.
  const std::string& problem() const { return problem_; }

 private:
  void tell_metre(const pipeline::Metre& metre);
  void append(const std::string& text);

  std::string path_;
  int file_ = -1;
  pipeline::Metre told_;
  std::string problem_;
};

}  // namespace unisim::replay
