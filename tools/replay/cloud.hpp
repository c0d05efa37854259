// SPDX-License-Identifier: MIT
// The fused point cloud of a run: depth of the windows, colour of the keyframes, final poses.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/temporary_file.hpp"
#include "tools/replay/run_data.hpp"
#include "unisim/unisim.h"

namespace unisim::replay {

struct CloudOptions {
  int32_t image_width = 0;  ///< pixels, of the frames that come without any; 0: not known
  int32_t image_height = 0;
  double confidence_drop = 0.25;          ///< share of least confident pixels of a view left out
  unisim_predictor* predictor = nullptr;  ///< whose view is coloured; nullptr: the frames
  double min_confidence = 0.0;  ///< pixels below it are left out too; its scale is the predictor's
};

/// CloudOptions::min_confidence for the geometric predictor: pixels between landmarks whose depths
/// agree are kept (as near to a depth camera as the landmarks themselves: 2.4-2.8 % against 2.1 %,
/// median on redkitchen), those across edges are not (4.5 % and more).
constexpr double kGeometricConfidence = 0.3;

/// Gathers views while the run goes on. For each keyframe it takes colours on a coarse grid and the
/// depth of its most confident submap (least center_sigma; where that is not known the largest mean
/// confidence), both at most kGridWidth cells wide. A view that no prediction will change any more
/// goes to disk: memory does not grow with the length of the run.
class Cloud : public pipeline::Listener {
 public:
  static constexpr int kGridWidth = 80;
  /// Newest keyframes whose views are in memory. Predictors that revise their windows hold fewer.
  static constexpr int32_t kViewsInMemory = 256;

  /// @param folder for a temporary file, "" for memory
  explicit Cloud(const CloudOptions& options = {}, const std::string& folder = "")
      : options_(options), settled_(folder) {}

  /// Images give the colours; without pixels a view is grey.
  void on_keyframe(int32_t id, const unisim_frame& frame) override;
  void on_window(int32_t submap_id, const unisim_window_prediction& window) override;
  void on_revision(int32_t submap_id, const unisim_window_revision& revision) override;
  void on_retired(const unisim_retired& retired, const unisim_pose* pose) override;

  /// Writes binary PLY: x y z float, red green blue uchar, confidence float, in the world of the
  /// poses. Of several segments only the longest: they have no common frame.
  /// @param radial_k1 of the predictor, 0 if none
  /// @return points written; throws std::runtime_error when the file cannot be written
  int64_t write(const std::filesystem::path& path, const RunData& poses, double radial_k1) const;

  int32_t views_in_memory() const { return static_cast<int32_t>(views_.size()); }

 private:
  using Rgb = std::array<uint8_t, 3>;

  struct Point {
    float x;  ///< of the image plane at depth 1, distortion not taken out
    float y;
    float depth;  ///< submap unit
    float confidence;
    Rgb colour;
  };

  struct View {
    double width = 0.0;  ///< of the image, pixels
    double height = 0.0;
    int columns = 0;  ///< of the colour grid
    int rows = 0;
    std::vector<Rgb> colours;
    int32_t submap_id = -1;
    int32_t index = 0;  ///< of the view in the window
    double center_sigma = std::numeric_limits<double>::infinity();
    double mean_confidence = 0.0;
    std::vector<Point> points;
  };

  /// Head of a view on disk; its points follow.
  struct SettledView {
    int32_t keyframe_id;
    int32_t submap_id;
    int64_t points;
  };

  struct PlacedView {
    const std::vector<Point>* points;
    const unisim_pose* pose;
    double scale;  // submap unit to the world
  };

  void settle(std::map<int32_t, View>::iterator view);
  template <typename Each>
  void for_each_placed(const RunData& poses, int32_t segment, bool with_points, Each each) const;
  static void put_vertices(const PlacedView& placed, double radial_k1, std::ostream* file);
  void take_depth(const unisim_depth_map& map, double focal_px, View* view) const;
  static Rgb colour_at(const View& view, double x, double y);
  float least_confidence(const unisim_depth_map& map, int step) const;

  CloudOptions options_;
  std::map<int32_t, View> views_;  // by keyframe id: those that may still change
  pipeline::TemporaryFile settled_;
};

}  // namespace unisim::replay
