// SPDX-License-Identifier: MIT
// A driver of sessions by random calls: sane ones, late ones, wrong ones.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "unisim/unisim.h"

namespace unisim::test {

/// How often the caller errs.
struct Habits {
  double garbage = 0.0;     ///< share of calls with a random field broken
  double reject = 0.05;     ///< share of requests rejected
  double noise = 0.01;      ///< of poses
  double metres = 0.0;      ///< share of keyframes with a distance or a submap's unit
  double reads = 1.0;       ///< share of the usual reading of poses and covariances
  double optimizes = 1.0;   ///< share of the usual optimisations
  int32_t keyframes = 600;  ///< after which it ends
};

/// Calls unisim.h at random on one session. All memory is taken in the constructor.
class RandomCaller {
 public:
  RandomCaller(unisim_session* session, const unisim_config& config, uint32_t seed,
               const Habits& habits);

  /// One call. false: the last keyframe, of the habits or of the session's capacity, is there.
  bool step();
  /// The session has been loaded: it has these already.
  void go_on(int32_t keyframes, int32_t submaps) {
    keyframes_ = keyframes;
    submaps_ = submaps;
  }
  /// Optimisations that found the solver's declared memory too small.
  int64_t solver_overflows() const { return solver_overflows_; }
  /// Calls answered with this status.
  int64_t count(unisim_status status) const { return counts_[static_cast<size_t>(status)]; }

 private:
  void note(unisim_status status) { ++counts_[static_cast<size_t>(status)]; }
  bool add_keyframe();
  void answer_request();
  void add_pair(const unisim_request& request);
  void add_window(const unisim_request& request);
  void add_loop();
  void update();
  void add_metres();
  void read();
  void optimize();
  void fill_depth();
  unisim_sim3 pose(double length);
  unisim_submap submap(int32_t count);
  void spoil(void* bytes, size_t size);
  bool chance(double share) { return uniform_(random_) < share; }
  int32_t below(int32_t end);

  static constexpr int32_t kWidth = 12;
  static constexpr int32_t kHeight = 9;

  unisim_session* session_;
  unisim_config config_;
  Habits habits_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  int32_t keyframes_ = 0;
  int32_t submaps_ = 0;
  int64_t solver_overflows_ = 0;
  std::vector<float> depth_;
  std::vector<unisim_depth_map> maps_;
  std::vector<unisim_sim3> poses_;
  std::vector<int32_t> ids_;
  std::vector<double> ratios_;
  std::vector<unisim_pose> trajectory_;
  std::vector<int64_t> counts_;
};

}  // namespace unisim::test
