// SPDX-License-Identifier: MIT
// Turns the running state into the predictions of drivers/predictor.h, in buffers of fixed size.
#pragma once

#include <string>
#include <vector>

#include "drivers/geometric/map/mapper.hpp"
#include "drivers/geometric/predict/depth_grid.hpp"
#include "drivers/geometric/predict/window_cut.hpp"
#include "drivers/predictor.h"

namespace unisim::geometric {

class Predictions {
 public:
  Predictions(const unisim_geometric_config& config, const cv::Size& image);

  /// @param[out] why one line when the answer is not OK
  int pair(const Mapper& mapper, int32_t i, int32_t j, unisim_pair_prediction* out,
           const char** why);
  int window(Mapper* mapper, const int32_t* ids, int32_t count, unisim_window_prediction* out,
             const char** why);
  int revision(const Mapper& mapper, unisim_window_revision* out);
  int wide_window(const Mapper& mapper, int32_t max_views, unisim_window_prediction* out);
  /// Says that the whole state was adjusted: every window may be due for a revision, and a wide
  /// window is.
  void state_adjusted() {
    windows_.look_again_at_all();
    wide_is_due_ = true;
  }
  /// Says that a keyframe was added, which moves the newest windows a little.
  void state_grew() { windows_.look_again_at_newest(); }
  int64_t bytes() const;

 private:
  /// Depth maps of one answer.
  struct Maps {
    std::vector<float> depth;
    std::vector<float> confidence;
  };
  unisim_depth_map fill(const State& state, int32_t keyframe, size_t view, Maps* maps);
  void choose_views(const State& state, const int32_t* ids, int32_t count);
  void cut_views(const State& state, unisim_window_prediction* out);

  cv::Size grid_size_;
  DepthGrid grid_;
  Maps pair_maps_;
  Maps window_maps_;
  std::vector<unisim_depth_map> depths_;
  std::vector<int32_t> ids_;
  std::vector<unisim_sim3> poses_;
  WindowCut windows_;
  WindowRevision revision_;
  bool wide_is_due_ = false;
  std::string remark_;  // of the last window
};

}  // namespace unisim::geometric
