// SPDX-License-Identifier: MIT
// Latest pose of any keyframe of a run, kept by the session or not.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/pipeline/pose_book.hpp"
#include "drivers/pipeline/temporary_file.hpp"
#include "unisim/unisim.h"

namespace unisim::pipeline {

/// For listeners that tell a run as it goes: hand it what on_retired() says.
class PoseHistory {
 public:
  /// @param folder on whose disk it lies, "" for memory
  explicit PoseHistory(const std::string& folder = "") : book_(folder), retired_(folder) {}

  /// @param pose of the keyframe that left; NULL for a submap
  void take(const unisim_retired& retired, const unisim_pose* pose);

  /// Pose of today; all else of a keyframe that has left is as it left. false: it has none
  bool read(const unisim_session* session, int32_t keyframe, unisim_pose* pose) const;

  const PoseBook& book() const { return book_; }

 private:
  PoseBook book_;
  RecordFile<unisim_pose> retired_;  // as they left the window
};

}  // namespace unisim::pipeline
