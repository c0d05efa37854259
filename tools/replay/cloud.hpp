// SPDX-License-Identifier: MIT
// The fused point cloud of a run: depth of the windows, colour of the keyframes, final poses.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "unisim/unisim.h"

namespace unisim::replay {

struct CloudOptions {
  double confidence_drop = 0.25;  ///< share of least confident pixels of a view left out
  double min_confidence = 0.0;  ///< pixels below it are left out too; its scale is the predictor's
};

/// CloudOptions::min_confidence for the geometric predictor: pixels between landmarks whose depths
/// agree are kept (as near to a depth camera as the landmarks themselves: 2.4-2.8 % against 2.1 %,
/// median on redkitchen), those across edges are not (4.5 % and more).
constexpr double kGeometricConfidence = 0.3;

/// Final poses that place the views.
struct CloudPoses {
  std::vector<unisim_pose> keyframes;
  std::vector<double> submap_scale;  ///< by submap id: submap unit to the world, 0 not known
};

CloudPoses read_cloud_poses(const unisim_session* session);

/// Gathers views while the run goes on. For each keyframe it keeps colours on a coarse grid and the
/// depth of its most confident submap (least center_sigma; where that is not known the largest mean
/// confidence), both at most kGridWidth cells wide: bounded for each keyframe.
class Cloud : public pipeline::Listener {
 public:
  static constexpr int kGridWidth = 80;

  explicit Cloud(const CloudOptions& options = {}) : options_(options) {}

  /// Images give the colours; without pixels a view is grey.
  void on_keyframe(int32_t id, const unisim_frame& frame) override;
  void on_window(int32_t submap_id, const unisim_window_prediction& window) override;
  void on_revision(int32_t submap_id, const unisim_window_revision& revision) override;

  /// Writes binary PLY: x y z float, red green blue uchar, confidence float, in the world of the
  /// poses. Of several segments only the longest: they have no common frame.
  /// @param radial_k1 of the predictor, 0 if none
  /// @return points written; throws std::runtime_error when the file cannot be written
  int64_t write(const std::filesystem::path& path, const CloudPoses& poses, double radial_k1) const;

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

  struct PlacedView {
    const View* view;
    const unisim_pose* pose;
    double scale;  // submap unit to the world
  };

  std::vector<PlacedView> place(const CloudPoses& poses, int32_t segment) const;
  static std::string vertices(const PlacedView& placed, double radial_k1);
  void take_depth(const unisim_depth_map& map, double focal_px, View* view) const;
  static Rgb colour_at(const View& view, double x, double y);
  float least_confidence(const unisim_depth_map& map, int step) const;

  CloudOptions options_;
  std::vector<View> views_;  // by keyframe id
};

}  // namespace unisim::replay
