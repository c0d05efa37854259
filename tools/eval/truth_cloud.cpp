// SPDX-License-Identifier: MIT
// The true cloud of a recording: its depth images at its true poses.
#include "tools/eval/truth_cloud.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "tools/common/voxel_grid.hpp"
#include "tools/eval/interpolation.hpp"

namespace unisim::eval {
namespace {

constexpr double kMostSteps = 2.0;    // between poses, of their usual step
constexpr double kLongestGap = 0.5;   // seconds
constexpr uint16_t kNoDepth = 65535;  // besides 0, in 7-Scenes

void add_image(const cv::Mat& depth, const DepthImages& found, const Pose& pose,
               const TruthOptions& options, tools::VoxelGrid* grid) {
  const DepthCamera& camera = found.camera;
  for (int v = 0; v < depth.rows; v += options.pixel_step) {
    const auto* row = depth.ptr<uint16_t>(v);
    for (int u = 0; u < depth.cols; u += options.pixel_step) {
      if (row[u] == 0 || row[u] == kNoDepth) continue;
      const double z = row[u] / found.units_per_metre;
      if (options.max_depth > 0.0 && z > options.max_depth) continue;
      const double x = (u - camera.cx) / camera.fx;
      const double y = (v - camera.cy) / camera.fy;
      const double side = (1.0 + camera.k1 * (x * x + y * y)) * z;
      const Eigen::Vector3d point = pose.R * Eigen::Vector3d(x * side, y * side, z) + pose.t;
      if (is_near(point)) grid->add({point.x(), point.y(), point.z()}, {}, 0.0, 1.0);
    }
  }
}

// The images asked for, as poses without one: what interpolate() wants to know of them.
Trajectory times_of(const DepthImages& found, const TruthOptions& options,
                    std::vector<const DepthImage*>* images) {
  Trajectory asked;
  int64_t number = 0;
  for (const DepthImage& image : found.images) {
    if (image.time_s < options.first_s || image.time_s > options.last_s) continue;
    if (number++ % options.every != 0) continue;
    asked.poses.push_back({image.time_s, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()});
    images->push_back(&image);
  }
  return asked;
}

}  // namespace

TruthCloud make_truth(const DepthImages& found, const TruthOptions& options) {
  std::vector<const DepthImage*> images;
  const Trajectory asked = times_of(found, options, &images);
  const double gap = std::min(kLongestGap, kMostSteps * median_step_s(found.truth));
  const Trajectory posed = interpolate(found.truth, asked, gap);
  tools::VoxelGrid grid(options.voxel, kMostThinned);
  TruthCloud truth;
  size_t next = 0;
  for (const DepthImage* image : images) {
    while (next < posed.poses.size() && posed.poses[next].time_s < image->time_s) ++next;
    if (next == posed.poses.size() || posed.poses[next].time_s != image->time_s) {
      ++truth.unposed;
      continue;
    }
    const cv::Mat depth = cv::imread(image->path, cv::IMREAD_UNCHANGED);
    if (depth.type() != CV_16UC1) {
      ++truth.unreadable;
      continue;
    }
    add_image(depth, found, posed.poses[next], options, &grid);
    ++truth.images;
  }
  truth.voxel = grid.side();
  truth.cloud.points.reserve(grid.size());
  for (size_t k = 0; k < grid.size(); ++k)
    truth.cloud.points.emplace_back(grid.point(k).position.data());
  if (truth.cloud.points.empty()) {
    throw InputError(found.truth.name + ": no depth image with a pose among " +
                     std::to_string(images.size()) + " (" + std::to_string(truth.unposed) +
                     " without, " + std::to_string(truth.unreadable) +
                     " not 16-bit): give poses of the same clock");
  }
  return truth;
}

}  // namespace unisim::eval
