// SPDX-License-Identifier: MIT
// Drives a geometric predictor through its table, as the pipeline does.
#pragma once

#include <memory>
#include <vector>

#include "drivers/geometric/geometric.h"
#include "tests/geometric/rendered_room.hpp"

namespace unisim::geometric::test {

class PredictorRun {
 public:
  explicit PredictorRun(const unisim_geometric_config& config);

  /// Shows one image. @return what observe() answered
  int show(const GrayImage& image, bool keyframe);
  /// Shows `count` frames of a path, every `stride`-th a keyframe.
  void show_path(CameraPlace (*path)(int), int count, int stride);
  int pair(int i) { return table_->two_view(table_.get(), i, i + 1, &pair_); }
  const unisim_pair_prediction& last_pair() const { return pair_; }
  /// Poses of keyframes [first, first + count) as the state has them now; empty when refused.
  std::vector<unisim_sim3> window(int first, int count);
  unisim_predictor_info info();

  unisim_predictor* table() { return table_.get(); }
  const unisim_motion& motion() const { return motion_; }
  int keyframes() const { return keyframes_; }
  /// The next keyframe has this number.
  void go_on_with(int keyframe) { keyframes_ = keyframe; }
  /// Places of the keyframes that show_path() made.
  const std::vector<CameraPlace>& places() const { return places_; }

 private:
  struct Destroy {
    void operator()(unisim_predictor* table) const { table->destroy(table); }
  };
  std::unique_ptr<unisim_predictor, Destroy> table_;
  unisim_motion motion_{};
  unisim_pair_prediction pair_{};
  std::vector<CameraPlace> places_;
  int frames_ = 0;
  int keyframes_ = 0;
};

unisim_geometric_config default_config();

inline constexpr int kStride = 3;
/// Shows steps [from, to) of the walk, every kStride-th a keyframe.
void show_walk(PredictorRun* run, int from, int to);

/// Largest distance of a centre from its true place after the best similarity, over the largest
/// distance between true centres.
double relative_error(const std::vector<unisim_sim3>& found, const std::vector<CameraPlace>& truth);

}  // namespace unisim::geometric::test
