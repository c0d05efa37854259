// SPDX-License-Identifier: MIT
// Windows of keyframes cut out of the running state, and their revisions when the state improves.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/map/state.hpp"
#include "unisim/unisim.h"

namespace unisim::geometric {

/// Camera-to-world similarity (scale 1) of a pose.
unisim_sim3 to_sim3(const CameraPose& pose);
/// T_i_j: camera j to camera i.
unisim_sim3 relative_sim3(const CameraPose& i, const CameraPose& j);

/// A window measured again.
struct WindowRevision {
  int64_t token = 0;
  int32_t first = 0;  ///< keyframes
  int32_t last = 0;
  double center_sigma = 0;
  std::vector<unisim_sim3> poses;
  std::vector<double> log_depth_ratio;
};

/// Remembers what was given out, within a fixed number of views; the oldest windows are forgotten.
class WindowCut {
 public:
  WindowCut(size_t max_views, size_t observations_per_keyframe);

  /// Notes a window of posed keyframes as given out now. @return its token
  int64_t give(const State& state, const int32_t* ids, size_t count, double center_sigma);
  /// The whole state was adjusted: next_revision() looks at every window again.
  void look_again_at_all();
  /// The newest keyframes were adjusted: next_revision() looks at the newest windows again.
  void look_again_at_newest();
  /// The next window whose poses or depths have changed noticeably. @return false when none is left
  bool next_revision(const State& state, WindowRevision* out);

  int64_t bytes() const;

 private:
  struct Window {
    int64_t token = -1;
    int64_t first_view = 0;  // counts all views ever given
    size_t count = 0;
    double center_sigma = 0;
  };
  struct View {
    int32_t keyframe = -1;
    CameraPose pose;
  };
  size_t place(int64_t view) const { return static_cast<size_t>(view) % views_.size(); }
  void record(const State& state, int32_t keyframe, int64_t view);
  bool measurable(const State& state, const Window& window) const;
  double log_depth_ratio(const State& state, int64_t view);
  bool changed(const State& state, const Window& window, const std::vector<double>& ratios) const;

  std::vector<View> views_;
  std::vector<float> depths_;     // of each view's observations; 0: none
  std::vector<uint32_t> owners_;  // generation of the landmark of that depth
  std::vector<Window> windows_;
  size_t per_view_;
  int64_t end_view_ = 0;
  int64_t end_token_ = 0;
  int64_t oldest_ = 0;  // oldest token remembered
  int64_t next_ = 0;    // next token to look at
  double noticeable_ = 0;
  std::vector<double> scratch_;
};

}  // namespace unisim::geometric
