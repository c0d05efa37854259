// SPDX-License-Identifier: MIT
// Pose of the present frame from the landmarks its tracks belong to.
#include "drivers/geometric/map/keyframe_pose.hpp"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "drivers/geometric/map/rolling_shutter.hpp"

namespace unisim::geometric {

namespace {
constexpr double kSoftWeight = 0.3;
constexpr int kMinInliers = 12;
constexpr double kMinInlierShare = 0.3;
constexpr double kRansacShare = 0.5;  // below this share of inliers RANSAC is tried
constexpr int kMinForRansac = 8;
constexpr double kMinOldShare = 0.5;
constexpr int kMinOldInliers = 15;
}  // namespace

void KeyframePose::reserve(size_t count) { observations_.reserve(count); }

PoseOptions KeyframePose::options(const State& state, double cauchy, double inlier,
                                  int iterations) const {
  PoseOptions out;
  out.pixel_scale = state.pixel_scale;
  out.cauchy = cauchy;
  out.inlier = inlier;
  out.max_iterations = iterations;
  return out;
}

void KeyframePose::collect_tracks(const State& state) {
  observations_.clear();
  for (size_t i = 0; i < state.tracks.size(); ++i) {
    const int32_t slot = state.tracks.landmark[i];
    const Landmark& mark = state.map.landmark(slot);
    if (mark.state != LandmarkState::kPlaced || state.map.support(slot) < 2) continue;
    const cv::Point2f& at = state.tracks.point[i];
    const Eigen::Vector2d still =
        still_pixel(at, sway_of(state, at, state.tracks.velocity[i]), state.intrinsics.readout_s);
    observations_.push_back(
        {mark.position, state.intrinsics.camera.undistort(still), mark.soft ? kSoftWeight : 1.0});
  }
}

CameraPose KeyframePose::best_start(const State& state, int32_t id) const {
  const int32_t last = state.posed_before(id);
  const CameraPose held = state.map.keyframe(last).pose;
  CameraPose moved = held;
  const int32_t before = state.posed_before(last);
  if (before >= 0) {
    const CameraPose& old = state.map.keyframe(before).pose;
    const Eigen::Matrix3d turn = held.R * old.R.transpose();
    moved.R = turn * held.R;
    moved.t = turn * held.t + (held.t - turn * old.t);
  }
  const auto count = static_cast<int>(observations_.size());
  const PoseOptions wide = options(state, 4.0, 2 * kInlierGate, 12);
  const CameraModel& camera = state.intrinsics.camera;
  const PoseResult a = solve_pose(camera, held, observations_.data(), count, wide, nullptr);
  const PoseResult b = solve_pose(camera, moved, observations_.data(), count, wide, nullptr);
  return b.cost < a.cost ? b.pose : a.pose;
}

FramePose KeyframePose::finish(const State& state, const CameraPose& start, int iterations) {
  const auto count = static_cast<int>(observations_.size());
  const PoseResult result = solve_pose(state.intrinsics.camera, start, observations_.data(), count,
                                       options(state, 1.0, 1.5 * kInlierGate, iterations), nullptr);
  FramePose out;
  out.pose = result.pose;
  out.inliers = result.inliers;
  out.used = count;
  out.good = result.status == PoseStatus::kOk && result.pose.t.allFinite() &&
             result.inliers >= kMinInliers && result.inliers >= kMinInlierShare * count;
  if (out.good && state.median_depth > 0) {
    const Eigen::Matrix<double, 6, 6> covariance = result.information.inverse();
    const double variance = covariance.topLeftCorner<3, 3>().trace() / 3;
    if (variance > 0) out.center_sigma = std::sqrt(variance) / state.median_depth;
  }
  return out;
}

FramePose KeyframePose::solve_new(const State& state, int32_t id) {
  collect_tracks(state);
  FramePose out = finish(state, best_start(state, id), 8);
  if (out.inliers < kRansacShare * out.used && out.used >= kMinForRansac) {
    CameraPose pose;
    if (ransac(state, &pose)) {
      const FramePose other = finish(state, pose, 15);
      if (other.inliers > out.inliers) out = other;
    }
  }
  return out;
}

FramePose KeyframePose::refine(const State& state, const CameraPose& start) {
  collect_tracks(state);
  return finish(state, start, 8);
}

FramePose KeyframePose::solve_old(const State& state, int32_t keyframe, const CameraPose& start) {
  observations_.clear();
  const Keyframe& from = state.map.keyframe(keyframe);
  for (int32_t i = 0; i < from.observations; ++i) {
    const Observation& seen = state.map.observation(keyframe, i);
    if (seen.landmark < 0) continue;
    const Landmark& mark = state.map.landmark(seen.landmark);
    if (mark.state != LandmarkState::kPlaced) continue;
    observations_.push_back(
        {mark.position, state.intrinsics.camera.undistort(seen.still(state.intrinsics.readout_s)),
         1.0});
  }
  const auto count = static_cast<int>(observations_.size());
  const PoseResult result = solve_pose(state.intrinsics.camera, start, observations_.data(), count,
                                       options(state, 2.0, 2 * kInlierGate, 15), nullptr);
  FramePose out;
  out.pose = result.pose;
  out.inliers = result.inliers;
  out.used = count;
  out.good = result.status == PoseStatus::kOk && result.pose.t.allFinite() &&
             result.inliers >= kMinOldInliers && result.inliers >= kMinOldShare * count;
  return out;
}

bool KeyframePose::ransac(const State& state, CameraPose* pose) const {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const PoseObservation& seen : observations_) {
    points.emplace_back(seen.point_world.x(), seen.point_world.y(), seen.point_world.z());
    pixels.emplace_back(seen.undistorted_px.x(), seen.undistorted_px.y());
  }
  const CameraModel& camera = state.intrinsics.camera;
  const cv::Matx33d calibration(camera.focal_px, 0, camera.cx, 0, camera.focal_px, camera.cy, 0, 0,
                                1);
  cv::Vec3d rotation;
  cv::Vec3d translation;
  std::vector<int> inliers;
  if (!cv::solvePnPRansac(points, pixels, calibration, cv::noArray(), rotation, translation, false,
                          200, static_cast<float>(3 * state.pixel_scale), 0.99, inliers,
                          cv::SOLVEPNP_EPNP)) {
    return false;
  }
  pose->R = rotation_exp({rotation[0], rotation[1], rotation[2]});
  pose->t = Eigen::Vector3d(translation[0], translation[1], translation[2]);
  return pose->R.allFinite() && pose->t.allFinite();
}

}  // namespace unisim::geometric
