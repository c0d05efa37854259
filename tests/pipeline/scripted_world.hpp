// SPDX-License-Identifier: MIT
// A camera path with exact depth, a source of its frames and a predictor that knows the truth and
// errs only where the script says so.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "drivers/predictor.h"
#include "drivers/source.h"

namespace unisim::testing {

/// True pose of frame `index`: camera-to-world, scale 1; frame 0 is the world.
unisim_sim3 true_pose(int64_t index);

/// a⁻¹ b for scale 1, lengths times `unit`.
unisim_sim3 relative_pose(const unisim_sim3& a, const unisim_sim3& b, double unit);

/// Frames 0 .. count-1, 30 a second, 16x12 gray.
class ScriptedSource {
 public:
  explicit ScriptedSource(int64_t count);

  unisim_source* table() { return &handle_.table; }

  std::set<int64_t> bad;                      ///< unreadable frames
  std::set<int64_t> resized;                  ///< frames of another size
  std::set<int64_t> repeated_time;            ///< frames with the time of the one before
  int64_t fails_at = -1;                      ///< frame at which the source gives up
  std::function<void(int64_t)> before_frame;  ///< called on the reader's thread
  std::function<void()> on_interrupt;         ///< called by interrupt()

 private:
  struct Handle {
    unisim_source table;
    ScriptedSource* self;
  };
  static ScriptedSource* self(unisim_source* source);
  int next(unisim_frame* frame);

  Handle handle_{};
  int64_t count_;
  int64_t next_ = 0;
  std::vector<uint8_t> pixels_;
  std::string message_;
};

/// Exact predictions, each in a unit of its own (a power of two, so that float depths stay exact).
class ScriptedPredictor {
 public:
  ScriptedPredictor();

  unisim_predictor* table() { return &handle_.table; }

  /// Unit of pair (i, i+1) and of the window that begins at keyframe i.
  static double pair_unit(int32_t i);
  static double window_unit(int32_t first);

  int32_t pending_until = 0;         ///< pairs and windows are PENDING before this many keyframes
  bool starts_at_end = false;        ///< pairs are PENDING before finish()
  std::set<int32_t> rejected_pairs;  ///< first keyframes
  int32_t found_again = -1;          ///< first keyframe of a pair over a gap ...
  int32_t gap = 0;                   ///< ... that begins so many keyframes before
  std::set<int32_t> guessed_pairs;   ///< with a scale that is a guess
  std::set<int32_t> nan_pairs;       ///< T_i_j not finite
  std::set<int32_t> empty_pairs;     ///< depth maps of size 0
  std::set<int32_t> rejected_windows;
  std::set<int32_t> failing_windows;
  std::set<int32_t> nan_windows;
  std::set<int32_t> uncertain_windows;  ///< center_sigma far beyond any gate
  bool wrong_window_ids = false;        ///< windows name keyframes that do not exist
  int64_t fails_at = -1;                ///< frame at which observe() fails
  double window_bend = 0.0;             ///< path of a window over that of its square: drift
  double window_noise = 0.0;            ///< added to positions until the revision takes it away
  double metres = 0.0;                  ///< of a true length, said with each window; 0: not said
  bool revises = false;                 ///< every window is revised once, at finish()
  int32_t wide_every = 0;      ///< keyframes from one exact wide window to the next; 0: none
  int32_t wide_given = 0;      ///< of them, the newest that was given
  bool revises_early = false;  ///< not at finish(), but as soon as it is asked
  std::function<void(int32_t)> before_keyframe;  ///< called before a keyframe is taken
  /// Called before a window is answered, with its first keyframe, on whatever thread asks.
  std::function<void(int32_t)> before_window;
  std::string no_start;                ///< what info() says of a run without a start
  double focal_sigma_px = 0.0;         ///< what info() says of a focal length of 500; 0: given
  double flow = 0.0;                   ///< what observe() reports per frame since the last keyframe
  std::map<int64_t, int32_t> reasons;  ///< UNISIM_REASON_* that observe() gives, by frame
  std::vector<int64_t> keyframes;      ///< frame indices as told by keyframe()
  int64_t observed = 0;
  int64_t moved_off = 0;  ///< observe() calls whose pixels were not those of the frame

 private:
  struct Handle {
    unisim_predictor table;
    ScriptedPredictor* self;
  };
  struct Window {
    int64_t token;
    std::vector<int32_t> ids;
  };
  /// Of one answer.
  struct Arrays {
    std::vector<int32_t> ids;
    std::vector<unisim_sim3> poses;
    std::vector<std::vector<float>> depths;
    std::vector<unisim_depth_map> maps;
  };
  static ScriptedPredictor* self(unisim_predictor* predictor);
  int observe(const unisim_frame* frame, unisim_motion* motion);
  int two_view(int32_t i, int32_t j, unisim_pair_prediction* out);
  int multi_view(const int32_t* ids, int32_t count, unisim_window_prediction* out);
  int next_revision(unisim_window_revision* out);
  int next_wide_window(int32_t max_views, unisim_window_prediction* out);
  int frame_pose(unisim_frame_pose* out);
  int save_map(unisim_map_write write, void* context) const;
  int load_map(unisim_map_read read, void* context, int32_t* next_keyframe);
  void give_window(Arrays* arrays, unisim_window_prediction* out) const;
  void fill_poses(double noise, double bend, Arrays* arrays) const;
  unisim_depth_map depth_of(int32_t keyframe, double unit, std::vector<float>* storage) const;

  int32_t keyframes_now() const;
  int64_t keyframe_frame(int32_t keyframe) const;

  Handle handle_{};
  mutable std::mutex mutex_;  // of keyframes
  std::string message_ = "scripted";
  int64_t newest_frame_ = -1;
  std::vector<float> depth_i_, depth_j_;
  Arrays window_, wide_, revision_;
  std::vector<double> log_ratios_;
  std::vector<Window> open_revisions_;
  int64_t next_token_ = 100;
  int32_t newest_asked_ = -1;  // keyframe of a window
  bool finished_ = false;
};

}  // namespace unisim::testing
