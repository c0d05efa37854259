// SPDX-License-Identifier: MIT
// Starts a segment: two keyframes far enough apart give the first poses and landmarks.
#include "drivers/geometric/start/bootstrap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "drivers/common/median.hpp"
#include "drivers/geometric/start/rotation_test.hpp"

namespace unisim::geometric {

namespace {
constexpr int32_t kMaxGap = 10;               // keyframes between the two
constexpr size_t kMinCommon = 40;             // tracks seen in both
constexpr double kMinDisplacement = 12;       // pixels at the reference diagonal
constexpr double kEssentialGate = 1.5;        // pixels at the reference diagonal
constexpr double kMaxRotationResidual = 1.0;  // pixels at the reference diagonal
constexpr double kMinPairParallaxRad = 0.3 * 0.017453292519943295;
constexpr double kMinMedianParallaxRad = 2.0 * 0.017453292519943295;
constexpr double kLastChanceParallaxRad = 1.2 * 0.017453292519943295;
constexpr double kLastChanceShare = 0.35;  // of the reference's features still in common
constexpr int kMinPlaced = 40;
constexpr double kMinPlacedShare = 0.5;
constexpr double kMinPosedShare = 0.6;
constexpr double kTolerance = 1e-3;

}  // namespace

void Bootstrap::reserve(size_t tracks) {
  from_.reserve(tracks);
  to_.reserve(tracks);
  landmarks_.reserve(tracks);
  inlier_.reserve(tracks);
}

void Bootstrap::correspondences(const State& state, int32_t id) {
  from_.clear();
  to_.clear();
  landmarks_.clear();
  const Keyframe& newest = state.map.keyframe(id);
  for (int32_t i = 0; i < newest.observations; ++i) {
    const Observation& now = state.map.observation(id, i);
    if (now.landmark < 0) continue;
    state.map.for_each_observation(now.landmark,
                                   [&](const ObservationRef& ref, const Observation& then) {
                                     if (ref.keyframe != reference_) return;
                                     from_.emplace_back(then.x, then.y);
                                     to_.emplace_back(now.x, now.y);
                                     landmarks_.push_back(now.landmark);
                                   });
  }
}

StartOutcome Bootstrap::attempt(State* state, int32_t id, MapAdjustment* adjustment,
                                LandmarkGrowth* growth, KeyframePose* poses) {
  reference_ = std::max({reference_, state->segment_start, id - kMaxGap});
  if (id <= reference_) return StartOutcome::kFirst;
  if (state->tracks.size() < kMinCommon) return StartOutcome::kTooFewFeatures;
  // Tracks that die fast leave too few in common with an old reference: take a newer one.
  for (correspondences(*state, id); from_.size() < kMinCommon; correspondences(*state, id)) {
    if (++reference_ >= id) return StartOutcome::kTracksDie;
  }
  std::vector<double> displacement(from_.size());
  for (size_t i = 0; i < from_.size(); ++i) displacement[i] = cv::norm(to_[i] - from_[i]);
  if (drivers::median(&displacement) < kMinDisplacement * state->pixel_scale) {
    return StartOutcome::kNotMoving;
  }
  const Intrinsics& intrinsics = state->intrinsics;
  if (rotation_residual_px(from_, to_, state->size, intrinsics.camera.focal_px,
                           intrinsics.focal_known) < kMaxRotationResidual * state->pixel_scale) {
    return StartOutcome::kRotationOnly;
  }
  const CameraModel camera = state->intrinsics.camera;
  StartOutcome outcome = relative_pose(state, id);
  if (outcome == StartOutcome::kStarted && !adjust(state, id, adjustment, growth, poses)) {
    outcome = StartOutcome::kNoGeometry;
  }
  if (outcome == StartOutcome::kStarted) return outcome;
  undo(state, id);
  state->intrinsics.camera = camera;
  return outcome;
}

StartOutcome Bootstrap::relative_pose(State* state, int32_t id) {
  const CameraModel& camera = state->intrinsics.camera;
  const cv::Matx33d calibration(camera.focal_px, 0, camera.cx, 0, camera.focal_px, camera.cy, 0, 0,
                                1);
  cv::Mat mask;
  const cv::Mat essential =
      cv::findEssentialMat(from_, to_, cv::Mat(calibration), cv::USAC_ACCURATE, 0.999,
                           kEssentialGate * state->pixel_scale, mask);
  if (essential.rows != 3 || mask.total() != from_.size()) return StartOutcome::kNoGeometry;
  inlier_.assign(mask.begin<uint8_t>(), mask.end<uint8_t>());
  cv::Matx33d rotation;
  cv::Vec3d translation;
  cv::recoverPose(essential, from_, to_, cv::Mat(calibration), rotation, translation, mask);
  Keyframe& first = state->map.keyframe(reference_);
  Keyframe& second = state->map.keyframe(id);
  first.pose = CameraPose{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) second.pose.R(r, c) = rotation(r, c);
    second.pose.t[r] = translation[r];
  }
  if (!second.pose.R.allFinite() || !second.pose.t.allFinite()) return StartOutcome::kNoGeometry;
  first.posed = second.posed = true;
  double parallax = 0;
  const int placed = place_landmarks(state, id, &parallax);
  const double common = static_cast<double>(from_.size());
  const bool last_chance = common < kLastChanceShare * first.observations;
  if (placed < kMinPlaced || placed < kMinPlacedShare * common) return StartOutcome::kNoGeometry;
  return parallax >= (last_chance ? kLastChanceParallaxRad : kMinMedianParallaxRad)
             ? StartOutcome::kStarted
             : StartOutcome::kNoParallax;
}

int Bootstrap::place_landmarks(State* state, int32_t id, double* median_parallax) {
  const CameraModel& camera = state->intrinsics.camera;
  TriangulationOptions options;
  options.min_parallax_rad = kMinPairParallaxRad;
  options.max_error = kTriangulationGate * state->pixel_scale / camera.focal_px;
  std::vector<double> parallax;
  for (size_t i = 0; i < landmarks_.size(); ++i) {
    if (!inlier_[i]) continue;
    const TriangulationView views[2] = {
        {&state->map.keyframe(reference_).pose, camera.normalize({from_[i].x, from_[i].y})},
        {&state->map.keyframe(id).pose, camera.normalize({to_[i].x, to_[i].y})}};
    const TriangulationResult result = triangulate(views, 2, options);
    if (result.status != TriangulationStatus::kOk) continue;
    Landmark& mark = state->map.landmark(landmarks_[i]);
    mark.position = result.position;
    mark.state = LandmarkState::kPlaced;
    mark.measured_at = id;
    parallax.push_back(result.parallax_rad);
  }
  *median_parallax = parallax.empty() ? 0 : drivers::median(&parallax);
  return static_cast<int>(parallax.size());
}

void Bootstrap::set_unit(State* state, int32_t id) {
  std::vector<double> depth;
  for (const int32_t slot : landmarks_) {
    const Landmark& mark = state->map.landmark(slot);
    if (mark.state == LandmarkState::kPlaced) depth.push_back(mark.position.z());
  }
  const double unit = drivers::median(&depth);
  if (!(unit > 0)) return;
  for (const int32_t slot : landmarks_) state->map.landmark(slot).position /= unit;
  state->map.keyframe(id).pose.t /= unit;
}

void Bootstrap::adjust_posed(State* state, int iterations, double gate, MapAdjustment* adjustment) {
  posed_.clear();
  for (const int32_t k : state->map.ids()) {
    if (k >= state->segment_start && state->map.keyframe(k).posed) posed_.push_back(k);
  }
  adjustment->build(*state, posed_.data(), posed_.size());
  adjustment->solve(iterations, kTolerance);
  adjustment->write_back(state);
  cull(state, posed_.data(), posed_.size(), gate);
}

bool Bootstrap::adjust(State* state, int32_t id, MapAdjustment* adjustment, LandmarkGrowth* growth,
                       KeyframePose* poses) {
  set_unit(state, id);
  const bool focal_known = state->intrinsics.focal_known;
  state->intrinsics.focal_known = true;  // two views alone do not tell the focal length
  adjust_posed(state, 10, 3 * kInlierGate, adjustment);
  state->intrinsics.focal_known = focal_known;
  pose_between(state, id, poses);
  adjust_posed(state, 15, 2 * kInlierGate, adjustment);
  for (int32_t slot = 0; slot < state->map.landmark_capacity(); ++slot) {
    const Landmark& mark = state->map.landmark(slot);
    if (mark.state == LandmarkState::kCandidate && mark.segment == state->segment &&
        mark.observations >= 3) {
      growth->triangulate_landmark(state, slot, 1.5 * kTriangulationGate);
    }
  }
  adjust_posed(state, 15, kInlierGate, adjustment);
  if (static_cast<double>(posed_.size()) < kMinPosedShare * (id - reference_ + 1)) return false;
  pose_before(state, poses);
  state->posed = 0;
  for (const int32_t k : state->map.ids()) {
    state->posed += k >= state->segment_start && state->map.keyframe(k).posed ? 1 : 0;
  }
  return true;
}

void Bootstrap::pose_between(State* state, int32_t id, KeyframePose* poses) {
  const CameraPose& last = state->map.keyframe(id).pose;
  const Eigen::AngleAxisd turn(last.R);
  for (int32_t k = reference_ + 1; k < id; ++k) {
    const double share = static_cast<double>(k - reference_) / (id - reference_);
    CameraPose start;
    start.R = Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
    start.t = share * last.t;
    const FramePose found = poses->solve_old(*state, k, start);
    Keyframe& between = state->map.keyframe(k);
    between.pose = found.pose;
    between.posed = found.good;
  }
}

void Bootstrap::pose_before(State* state, KeyframePose* poses) {
  CameraPose start = state->map.keyframe(reference_).pose;
  for (int32_t k = reference_ - 1; k >= state->segment_start && state->map.holds(k); --k) {
    const FramePose found = poses->solve_old(*state, k, start);
    if (!found.good) return;
    Keyframe& before = state->map.keyframe(k);
    before.pose = start = found.pose;
    before.posed = true;
    mark_outliers(state, k, 2 * kInlierGate);
  }
}

void Bootstrap::undo(State* state, int32_t id) {
  for (int32_t k = reference_; k <= id; ++k) state->map.keyframe(k).posed = false;
  for (int32_t slot = 0; slot < state->map.landmark_capacity(); ++slot) {
    Landmark& mark = state->map.landmark(slot);
    if (mark.segment != state->segment || mark.state == LandmarkState::kFree) continue;
    mark.state = LandmarkState::kCandidate;
    mark.failures = 0;
    state->map.for_each_observation(
        slot, [](const ObservationRef&, Observation& seen) { seen.outlier = false; });
  }
}

}  // namespace unisim::geometric
