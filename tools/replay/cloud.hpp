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
#include "tools/common/voxel_grid.hpp"
#include "tools/replay/run_data.hpp"
#include "tools/replay/surface_fit.hpp"
#include "unisim/unisim.h"

namespace unisim::replay {

struct CloudOptions {
  int32_t image_width = 0;  ///< pixels, of the frames that come without any; 0: not known
  int32_t image_height = 0;
  double confidence_drop = 0.25;          ///< share of least confident pixels of a view left out
  unisim_predictor* predictor = nullptr;  ///< whose view is coloured; nullptr: the frames
  double min_confidence = 0.0;  ///< pixels below it are left out too; its scale is the predictor's
  /// Pixels below it are fitted to those around (SurfaceFit). 0: they are not.
  double sure_confidence = 0.0;
  /// Windows are of one focal length, known better and better: the last holds for all. false: each
  /// window has its own.
  bool one_camera = false;
  /// Cubes with one point each have this share of the mean depth as their side. 0: all points.
  double voxel = 0.0;
  /// Points that are sorted into cubes. Of a run with more an even share of each view is taken, so
  /// that a long run does not take longer to end.
  int64_t most_points = 1 << 19;
};

/// CloudOptions::voxel of unisim-replay: a third of the distance of two points of one view.
constexpr double kVoxelShare = 0.005;

/// CloudOptions::sure_confidence for the geometric predictor: cells with a landmark whose depth is
/// not a guess.
constexpr double kGeometricSure = 0.75;

/// CloudOptions::min_confidence for the geometric predictor, of fitted pixels (of those well inside
/// of neighbours that agree 0.5). Chosen on a room and a desk of unisim-synth, shown on tsdf_box:
/// 0.15 has fewer holes and more that hangs across edges, 0.25 the other way; the Chamfer distances
/// differ by up to 5 %.
constexpr double kGeometricConfidence = 0.2;

/// The camera as the predictor knows it at the end of a run.
struct CloudCamera {
  double radial_k1 = 0.0;    ///< 0: no distortion
  double focal_px = 0.0;     ///< 0: not known
  double center_x_px = 0.0;  ///< principal point, from the middle of the image
  double center_y_px = 0.0;
};

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

  static constexpr size_t kMostVoxels = 1U << 18U;  ///< while write() runs

  /// Writes binary PLY: x y z float, red green blue uchar, confidence float, in the world of the
  /// poses. Of several segments only the longest: they have no common frame.
  /// @return points written; throws std::runtime_error when the file cannot be written
  int64_t write(const std::filesystem::path& path, const RunData& poses,
                const CloudCamera& camera) const;

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
    double focal_px = 0.0;      ///< of the window, which the points are made with
    std::vector<Point> points;  // any first part of them is an even choice
    double log_depth = 0.0;     // sum over points
  };

  /// Head of a view on disk; its points follow.
  struct SettledView {
    int32_t keyframe_id;
    int32_t submap_id;
    int64_t points;
    double focal_px;
    double log_depth;
  };

  struct PlacedView {
    const Point* points;  // as many as were asked for
    int64_t count;        // of all
    double log_depth;
    double focal_px;
    const unisim_pose* pose;
    double scale;  // submap unit to the world
  };

  void settle(std::map<int32_t, View>::iterator view);
  template <typename Each>
  void for_each_placed(const RunData& poses, int32_t segment, double share, Each each) const;
  template <typename Each>
  void for_each_point(const PlacedView& placed, double share, const CloudCamera& camera,
                      Each each) const;
  void take_depth(int32_t id, const unisim_depth_map& map, double focal_px, View* view);
  tools::VoxelGrid thinned(const RunData& poses, int32_t segment, const CloudCamera& camera) const;
  static std::vector<Rgb> colours_of(const View& view, const unisim_depth_map& map);
  static Rgb colour_at(const View& view, double x, double y);
  float least_confidence(const unisim_depth_map& map, int step) const;

  CloudOptions options_;
  std::map<int32_t, View> views_;  // by keyframe id: those that may still change
  pipeline::TemporaryFile settled_;
  SurfaceFit surface_;
};

}  // namespace unisim::replay
