// SPDX-License-Identifier: MIT
// A session with its arena that takes simulated predictions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/pipeline/heap_watch.hpp"
#include "drivers/pipeline/pose_book.hpp"
#include "tools/bench/simulator/predictor.hpp"
#include "tools/bench/walk/snapshot_run.hpp"
#include "unisim/unisim.h"

namespace unisim::bench {

/// Calls that fail throw replay::Failure with the name of the call.
class WalkSession {
 public:
  /// @param heap outlives the session
  WalkSession(const unisim_config& config, const pipeline::HeapWatch& heap);
  ~WalkSession();
  WalkSession(const WalkSession&) = delete;
  WalkSession& operator=(const WalkSession&) = delete;

  size_t arena_bytes() const { return arena_.size(); }
  /// Of them for depth maps.
  size_t depth_bytes() const { return depth_bytes_; }
  void add_keyframe();
  void add_pair(const simulator::Prediction& pair);
  /// Keyframes of the oldest window asked for. @return false when there is none
  bool next_window(int32_t* first, int32_t* count);
  /// Ask for the last, shorter window. @return false when no keyframes are left over
  bool close_window();
  void add_window(const simulator::Prediction& window);
  /// @return false when a place is no longer kept
  bool add_loop(const simulator::Prediction& loop);
  void optimize(int32_t iterations);
  /// Take what has left the window, to know its position for ever.
  void read_retired();
  Eigen::Vector3d position(int32_t keyframe) const;
  unisim_session_info info() const;
  /// Save the map and load it into another session.
  SnapshotResult snapshot() const { return run_snapshot(session_, config_, heap_); }

 private:
  void expect_ok(unisim_status status, const char* call) const;
  unisim_submap describe(const simulator::Prediction& prediction);

  unisim_config config_;
  std::vector<unsigned char> arena_;
  size_t depth_bytes_ = 0;
  unisim_session* session_ = nullptr;
  const pipeline::HeapWatch& heap_;
  pipeline::PoseBook book_;
  int64_t keyframes_ = 0;
  std::vector<unisim_sim3> poses_;
  std::vector<unisim_depth_map> maps_;
};

}  // namespace unisim::bench
