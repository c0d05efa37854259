// SPDX-License-Identifier: MIT
// Where in the map an image was taken.
#include "drivers/geometric/places/place_finder.hpp"

#include <algorithm>

#include "drivers/geometric/places/pose_fit.hpp"
#include "drivers/geometric/places/pose_search.hpp"

namespace unisim::geometric {

namespace {

constexpr int32_t kSpread = 4;  // keyframes between candidates: neighbours show the same
constexpr size_t kMinMatches = 8;
constexpr double kPoseGate = 4.0;  // pixels at the reference diagonal
constexpr double kPoseGates[kFitRounds + 1] = {kPoseGate, kPoseGate, kPoseGate, kPoseGate};
// Of a frame that is looked for by itself: see find_quickly().
constexpr int32_t kQuickFeatures = 300;
constexpr size_t kVerified = 3;
constexpr size_t kLikely = 12;   // quick matches with which a place is verified at once
constexpr double kLinked = 0.5;  // share of a place's landmarks the keyframe sees anyway

int32_t asked_of(PlaceFinder::Scope scope) {
  switch (scope) {
    case PlaceFinder::Scope::kSegment:
      return UNISIM_PLACE_LOOP;
    case PlaceFinder::Scope::kOtherSegments:
      return UNISIM_PLACE_JOIN;
    case PlaceFinder::Scope::kAll:
      break;
  }
  return UNISIM_PLACE_LOST;
}

}  // namespace

PlaceFinder::PlaceFinder(const unisim_geometric_config& config, PatchAtlas* atlas)
    : config_(config), list_(config.max_keyframes), viewer_(config.max_landmarks), check_(atlas) {}

void PlaceFinder::open(const cv::Size& size) { orb_.open(size, config_.mask); }

void PlaceFinder::see(const cv::Mat& gray, int32_t id) {
  orb_.describe(gray, &features_);
  describable_ = describe_image(features_.descriptor, descriptor_.data());
  seen_ = id;
}

void PlaceFinder::add(const State& state) {
  list_.keep(state.map.ids());
  if (describable_) list_.add(seen_, descriptor_.data());
}

bool PlaceFinder::find(const State& state, const DescriptorStore& store, const PatchStore& patches,
                       const PreparedImage& current, const Question& question, PlaceFound* out,
                       drivers::PlaceReports* log) {
  if (!describable_) return false;
  list_.keep(state.map.ids());
  int32_t tried = 0;
  for (const unisim_places_match& match :
       list_.query(seen_, descriptor_.data(), question.gap, kSpread, config_.max_keyframes)) {
    if (tried == question.tries) break;
    const Keyframe& from = state.map.keyframe(match.id);
    const bool here = from.segment == state.segment;
    if (!from.posed || (question.scope == Scope::kSegment && !here)) continue;
    if (question.scope == Scope::kOtherSegments && here) continue;
    ++tried;
    unisim_place_report report{};
    report.keyframe = seen_;
    report.candidate = match.id;
    report.asked = asked_of(question.scope);
    report.score = match.score;
    viewer_.collect(state, store, match.id, &view_);
    bool good = false;
    if (question.scope == Scope::kSegment && linked(state)) {
      report.reason = "seen together already";
    } else {
      good = verify(state, patches, current, out, &report);
    }
    log->add(report);
    if (good) return true;
  }
  return false;
}

bool PlaceFinder::find_quickly(const State& state, const DescriptorStore& store,
                               const PatchStore& patches, const PreparedImage& current,
                               const Question& question, int32_t skip, PlaceFound* out, bool* end) {
  *end = true;
  if (!describable_) return false;
  list_.keep(state.map.ids());
  candidates_.clear();
  size_t likely_tried = 0;
  for (const unisim_places_match& match :
       list_.query(seen_, descriptor_.data(), question.gap, kSpread, config_.max_keyframes)) {
    if (!state.map.keyframe(match.id).posed || skip-- > 0) continue;
    *end = static_cast<int32_t>(candidates_.size()) < question.tries;
    if (!*end) break;
    viewer_.collect(state, store, match.id, &view_);
    match_features(features_, view_.descriptor, view_.owner, view_.landmark.size(), kQuickFeatures,
                   &pairs_);
    unisim_place_report report{};
    const bool likely = pairs_.size() >= kLikely && likely_tried < kVerified;
    if (likely && verify(state, patches, current, out, &report)) return true;
    likely_tried += likely ? 1 : 0;
    candidates_.push_back({match.id, likely ? 0 : pairs_.size()});
  }
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.matches > b.matches; });
  for (size_t k = 0; k + likely_tried < std::min(kVerified, candidates_.size()); ++k) {
    viewer_.collect(state, store, candidates_[k].keyframe, &view_);
    unisim_place_report report{};
    if (verify(state, patches, current, out, &report)) return true;
  }
  return false;
}

/// The keyframe sees the place's landmarks already: nothing new would be learnt.
bool PlaceFinder::linked(const State& state) const {
  size_t followed = 0;
  for (size_t l = 0; l < view_.own; ++l) {
    followed += state.map.landmark(view_.landmark[l]).followed ? 1 : 0;
  }
  return static_cast<double>(followed) >= kLinked * static_cast<double>(view_.own);
}

bool PlaceFinder::verify(const State& state, const PatchStore& patches,
                         const PreparedImage& current, PlaceFound* out,
                         unisim_place_report* report) {
  CameraPose pose;
  return pose_from_features(state, &pose, report) &&
         check(state, patches, current, pose, out, report);
}

bool PlaceFinder::look_near(const State& state, const DescriptorStore& store,
                            const PatchStore& patches, const PreparedImage& current,
                            int32_t keyframe, const CameraPose& expected, PlaceFound* out) {
  viewer_.collect(state, store, keyframe, &view_);
  unisim_place_report report{};
  return check(state, patches, current, expected, out, &report);
}

/// The patches decide.
bool PlaceFinder::check(const State& state, const PatchStore& patches, const PreparedImage& current,
                        const CameraPose& pose, PlaceFound* out, unisim_place_report* report) {
  check_.run(state, patches, current, view_.landmark.data(), view_.own, pose, &checked_);
  report->in_view = checked_.in_view;
  report->patch_inliers = static_cast<int32_t>(checked_.inliers.size());
  if (report->patch_inliers < config_.min_inliers) {
    report->reason = "the landmarks look otherwise";
    return false;
  }
  if (report->patch_inliers < config_.min_share * report->in_view) {
    report->reason = "most landmarks in view look otherwise";
    return false;
  }
  report->accepted = 1;
  report->reason = "accepted";
  out->keyframe = view_.keyframe;
  out->pose = checked_.pose;
  out->in_view = checked_.in_view;
  out->matches = checked_.inliers;
  return true;
}

bool PlaceFinder::pose_from_features(const State& state, CameraPose* pose,
                                     unisim_place_report* report) {
  match_features(features_, view_.descriptor, view_.owner, view_.landmark.size(), kOrbFeatures,
                 &pairs_);
  report->matches = static_cast<int32_t>(pairs_.size());
  report->reason = "too few features match";
  if (pairs_.size() < kMinMatches) return false;
  report->reason = "the matches agree on no pose";
  // The nearest are the most trusted.
  std::sort(pairs_.begin(), pairs_.end(), [](const FeaturePair& a, const FeaturePair& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.feature < b.feature;
  });
  const CameraModel& camera = state.intrinsics.camera;
  observations_.clear();
  for (const FeaturePair& pair : pairs_) {
    const int32_t slot = view_.landmark[static_cast<size_t>(pair.group)];
    const cv::Point2f& at = features_.point[static_cast<size_t>(pair.feature)];
    observations_.push_back(
        {state.map.landmark(slot).position, camera.undistort({at.x, at.y}), 1.0});
  }
  if (search_pose(camera, observations_, kPoseGate * state.pixel_scale, pose) == 0) return false;
  report->pose_inliers = fit_pose(state, &observations_, kPoseGates, pose, &inlier_);
  return report->pose_inliers >= config_.min_pnp;
}

int64_t PlaceFinder::bytes() const {
  const size_t features = kOrbFeatures * (sizeof(cv::Point2f) + kOrbBytes);
  return list_.bytes() + orb_.bytes() + static_cast<int64_t>(features) + config_.max_landmarks;
}

}  // namespace unisim::geometric
