// SPDX-License-Identifier: MIT
// Whether landmarks look as their patches say at a supposed pose.
#include "drivers/geometric/places/patch_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/common/median.hpp"
#include "drivers/geometric/image/frame_tracker.hpp"
#include "drivers/geometric/places/pose_fit.hpp"

namespace unisim::geometric {

namespace {

constexpr float kTileMiddle = 0.5F * (kPatchSide - 1);
constexpr float kMargin = 12.0F;      // from the border to what is looked for
constexpr double kMaxScale = 2.5;     // between the depths of patch and image
constexpr double kMinStretch = 0.05;  // determinant of the map from patch to image
// Pixels at the reference diagonal from the projection; later rounds start at a better pose, and go
// on while that finds more.
constexpr double kReach[] = {15.0, 8.0, 8.0, 8.0};
constexpr double kGrowth = 1.1;   // of the inliers, from round to round, else it is the last
constexpr double kFlat = 2.0;     // grey levels: a patch that says nothing on the contrast
constexpr double kMaxGain = 4.0;  // beyond, grey levels are too few
constexpr double kGates[kFitRounds + 1] = {16.0, 8.0, 4.0, 3.0};

}  // namespace

/// A patch is seen as a plane that faced its camera.
bool PatchCheck::aim(const State& state, const PatchStore& patches, int32_t landmark,
                     const CameraPose& pose, Target* out) const {
  const Landmark& mark = state.map.landmark(landmark);
  const CameraModel& camera = state.intrinsics.camera;
  const Eigen::Vector3d here = pose.apply(mark.position);
  Eigen::Vector2d pixel;
  if (!camera.project(here, &pixel)) return false;
  out->expected = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
  if (!inside_image(out->expected, state.size, kMargin)) return false;
  double best = -2;
  Eigen::Vector3d there = Eigen::Vector3d::Zero();
  CameraPose view_pose;
  for (int v = 0; v < kPatchesPerLandmark; ++v) {
    const PatchView& view = patches.view(landmark, v);
    if (view.generation != mark.generation || !state.map.holds(view.keyframe)) continue;
    const Keyframe& from = state.map.keyframe(view.keyframe);
    if (!from.posed || from.segment != mark.segment) continue;
    const double cosine = (mark.position - from.pose.center())
                              .normalized()
                              .dot((mark.position - pose.center()).normalized());
    if (cosine <= best) continue;
    best = cosine;
    out->patch = v;
    view_pose = from.pose;
    there = from.pose.apply(mark.position);
  }
  if (best < 0 || !(there.z() > kMinDepth)) return false;
  const double scale = there.z() / here.z();
  if (!(scale < kMaxScale && scale > 1 / kMaxScale)) return false;
  const Eigen::Matrix3d turn = pose.R * view_pose.R.transpose();
  const double step = there.z() / camera.focal_px;  // one pixel of the patch
  const auto moved = [&](const Eigen::Vector3d& offset) -> Eigen::Vector2d {
    const Eigen::Vector3d point = here + turn * offset;
    return camera.focal_px * point.head<2>() / point.z();
  };
  const Eigen::Vector2d middle = moved({0, 0, 0});
  Eigen::Matrix2d image_of_patch;
  image_of_patch.col(0) = moved({step, 0, 0}) - middle;
  image_of_patch.col(1) = moved({0, step, 0}) - middle;
  if (!(std::abs(image_of_patch.determinant()) > kMinStretch)) image_of_patch.setIdentity();
  const Eigen::Matrix2d back = image_of_patch.inverse();
  const cv::Point2f& offset = patches.view(landmark, out->patch).offset;
  const Eigen::Vector2d at(kPatchSide / 2 + offset.x, kPatchSide / 2 + offset.y);
  const Eigen::Vector2d corner = at - back * Eigen::Vector2d(kTileMiddle, kTileMiddle);
  out->landmark = landmark;
  out->patch_of_tile = {back(0, 0), back(0, 1), corner.x(), back(1, 0), back(1, 1), corner.y()};
  return true;
}

/// Patches kept in another light get the contrast of the image: one factor for all.
void PatchCheck::match_contrast(const cv::Mat& image) {
  ratios_.clear();
  const cv::Size side(kPatchSide, kPatchSide);
  for (size_t j = 0; j < atlas_.size(); ++j) {
    cv::Scalar mean, sigma_tile, sigma_image;
    cv::meanStdDev(atlas_.tile(j), mean, sigma_tile);
    const cv::Rect around(cv::Point(atlas_.expected(j)) - cv::Point(kPatchSide / 2, kPatchSide / 2),
                          side);
    cv::meanStdDev(image(around & cv::Rect(cv::Point(), image.size())), mean, sigma_image);
    if (sigma_tile[0] > kFlat) ratios_.push_back(sigma_image[0] / sigma_tile[0]);
  }
  if (ratios_.empty()) return;
  const double gain = std::clamp(drivers::median(&ratios_), 1 / kMaxGain, kMaxGain);
  atlas_.gray().convertTo(atlas_.gray(), CV_8U, gain, kMiddleGray * (1 - gain));
}

void PatchCheck::draw(const PatchStore& patches, size_t i, size_t j) {
  const Target& target = targets_[i];
  cv::Mat drawn = atlas_.tile(j);
  cv::warpAffine(patches.pixels(target.landmark, target.patch), drawn, target.patch_of_tile,
                 drawn.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  atlas_.add(cv::Point2f(atlas_.corner(j)) + cv::Point2f(kTileMiddle, kTileMiddle),
             target.expected);
}

void PatchCheck::follow(const State& state, const PatchStore& patches, const PreparedImage& current,
                        double reach, std::vector<PatchMatch>* found) {
  const auto take = [&](size_t i, size_t j) {
    if (!atlas_.found(j, current, reach, kTrackMargin)) return;
    const int32_t landmark = targets_[i].landmark;
    found->push_back({landmark, state.map.landmark(landmark).generation, atlas_.found_at(j)});
  };
  atlas_.look_for(
      targets_.size(), current, kUsualTexture, [&](size_t i, size_t j) { draw(patches, i, j); },
      [&] { match_contrast(current.gray); }, take);
}

void PatchCheck::run(const State& state, const PatchStore& patches, const PreparedImage& current,
                     const int32_t* landmarks, size_t count, const CameraPose& start,
                     PatchCheckResult* out) {
  out->pose = start;
  size_t before = 0;
  for (const double reach : kReach) {
    targets_.clear();
    for (size_t l = 0; l < count; ++l) {
      Target target{};
      if (aim(state, patches, landmarks[l], out->pose, &target)) targets_.push_back(target);
    }
    out->in_view = static_cast<int>(targets_.size());
    out->inliers.clear();
    follow(state, patches, current, reach * state.pixel_scale, &out->inliers);
    observations_.clear();
    for (const PatchMatch& match : out->inliers) {
      observations_.push_back({state.map.landmark(match.landmark).position,
                               state.intrinsics.camera.undistort({match.point.x, match.point.y}),
                               1.0});
    }
    if (fit_pose(state, &observations_, kGates, &out->pose, &inlier_) == 0) {
      out->inliers.clear();
      return;
    }
    size_t kept = 0;
    for (size_t i = 0; i < inlier_.size(); ++i) {
      if (inlier_[i]) out->inliers[kept++] = out->inliers[i];
    }
    out->inliers.resize(kept);
    if (before > 0 && static_cast<double>(kept) < kGrowth * static_cast<double>(before)) return;
    before = kept;
  }
}

}  // namespace unisim::geometric
