// SPDX-License-Identifier: MIT
// The running map: what is done with each frame and each keyframe, and in which order.
#include "drivers/geometric/map/mapper.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "drivers/geometric/map/capacities.hpp"
#include "drivers/geometric/map/join_segments.hpp"
#include "drivers/geometric/map/rolling_shutter.hpp"
#include "drivers/geometric/start/start_report.hpp"

namespace unisim::geometric {

namespace {

constexpr double kSpacing = 0.6;  // of the mean distance between evenly spread features
constexpr int32_t kLoopGap = 10;  // keyframes from one adjustment to the next when a loop waits
constexpr int kLoopIterations = 6;
constexpr int kEarlyIterations = 8;
constexpr int kWindowIterations = 4;
constexpr double kWindowTolerance = 1e-2;
constexpr int kWholeIterations = 6;
constexpr int32_t kWholeGapShare =
    10;  // of the keyframes held: least gap between adjustments of all
constexpr int kFinalIterations = 15;
constexpr int kFinalRounds = 2;
constexpr double kTurnRad = 0.017;       // turned on the spot: at least this angle ...
constexpr double kTurnBaseline = 0.003;  // ... and at most this baseline over median depth

}  // namespace

Mapper::Mapper(const unisim_geometric_config& config, const cv::Size& size)
    : state_(config, map_capacity(config)),
      patches_(config.max_landmarks),
      revive_(&atlas_),
      remeasure_(&atlas_),
      places_(state_.config, static_cast<size_t>(observations_per_keyframe(config)), &atlas_),
      lost_tracks_(&places_.orb(), &atlas_),
      window_(window_capacity(config), map_capacity(config)),
      background_(whole_capacity(config), map_capacity(config), config.background != 0) {
  state_.size = size;
  state_.pixel_scale = std::hypot(size.width, size.height) / kReferenceDiagonal;
  state_.feature_spacing = std::max(
      1,
      static_cast<int>(kSpacing * std::sqrt(static_cast<double>(size.area()) / config.max_tracks)));
  const bool lens_known = config.distortion_model != UNISIM_DISTORTION_UNKNOWN;
  const bool center_given = config.principal_x_px != 0 || config.principal_y_px != 0;
  state_.intrinsics =
      Intrinsics::start(size, config.focal_px, lens_known, lens_known || center_given);
  if (config.shutter == UNISIM_SHUTTER_ROLLING) state_.intrinsics.roll(1e-3 * config.readout_ms);
  const auto tracks = static_cast<size_t>(observations_per_keyframe(config));
  state_.tracks.reserve(tracks);
  lost_tracks_.reserve(config.max_tracks, tracks);
  places_.open(size);
  front_end_.open(size, config.max_tracks, state_.feature_spacing, config.mask);
  poses_.reserve(tracks);
  growth_.reserve(tracks, static_cast<size_t>(config.max_keyframes));
  bootstrap_.reserve(tracks);
  zoom_.reserve(tracks);
  turns_.reserve(static_cast<size_t>(config.max_keyframes));
  atlas_.open(size);
  revive_.reserve(static_cast<size_t>(config.max_landmarks));
  remeasure_.reserve(tracks);
  joined_ids_.reserve(static_cast<size_t>(config.max_keyframes));
  window_ids_.reserve(static_cast<size_t>(config.max_keyframes));
}

void Mapper::see(const unisim_frame& frame) {
  keep_place();
  frame_ = frame.index;
  state_.frame_step_s = 1e-9 * static_cast<double>(frame.timestamp_ns - time_ns_);
  time_ns_ = frame.timestamp_ns;
  front_end_.see(frame.image, frame.timestamp_ns, &state_.tracks);
  if (after_keyframe_) see_motion_after(&state_);
  after_keyframe_ = false;
  if (front_end_.jumped()) tell_zoom(frame_);
  if (counts_.started == 0) start_.see_frame(front_end_.gray());
}

void Mapper::tell_once(bool* told, const std::string& what) {
  if (*told) return;
  *told = true;
  if (!remark_.empty()) remark_ += "; ";
  remark_ += what;
}

/// What follows a zoom, another one too, is of another size anyway.
void Mapper::tell_zoom(int64_t frame) {
  tell_once(&zoom_told_,
            "the camera seems to have zoomed near frame " + std::to_string(frame) +
                ": poses and depths after it are of another size and bent; film without zoom");
}

/// The state says so each time.
void Mapper::tell_turn() {
  tell_once(&turn_told_,
            "the camera turned on the spot near frame " + std::to_string(frame_) +
                " until nothing it had measured was in view: how large things are from there on "
                "is a guess, and the state DEGRADED, until a place from before is seen again");
}

void Mapper::note_followed() {
  for (int32_t slot = 0; slot < state_.map.landmark_capacity(); ++slot) {
    state_.map.landmark(slot).followed = false;
  }
  for (const int32_t slot : state_.tracks.landmark) state_.map.landmark(slot).followed = true;
  state_.map.free_abandoned();
}

void Mapper::let_go() {
  for (const int32_t slot : state_.tracks.landmark) state_.map.landmark(slot).followed = false;
}

void Mapper::observe_tracks(size_t first) {
  for (size_t i = first; i < state_.tracks.size(); ++i) {
    const cv::Point2f& at = state_.tracks.point[i];
    state_.map.observe(state_.tracks.landmark[i], at,
                       sway_of(state_, at, state_.tracks.velocity[i]));
  }
}

void Mapper::detect_tracks() {
  const size_t first = state_.tracks.size();
  for (const cv::Point2f& p : front_end_.detect(state_.tracks)) {
    const int32_t slot = state_.map.add_landmark(state_.segment);
    state_.map.landmark(slot).followed = true;
    state_.tracks.add(p, front_end_.flow(), slot);
  }
  observe_tracks(first);
}

bool Mapper::add_keyframe(int32_t id) {
  front_end_.begin_keyframe(&state_.tracks);
  look_for_lost_tracks();
  if (counts_.started == 0) {
    start_.see_keyframe(state_.tracks, front_end_.sealed(), state_.pixel_scale,
                        front_end_.current().gray);
  }
  note_followed();
  bool adjusted = false;
  if (background_.running() && id >= background_.due_at(state_.config.adjust_latency)) {
    adjusted = background_.merge(&state_, &poses_);
    turns_.settle(state_);
  }
  if (state_.initialised) {
    track(id);
  } else if (counts_.started == 0 || !relocalise(id)) {
    try_start(id);
  }
  front_end_.end_keyframe(&state_.tracks);
  lost_tracks_.note_keyframe(state_);
  after_keyframe_ = true;
  return adjusted;
}

void Mapper::try_start(int32_t id) {
  state_.map.push_keyframe(id, state_.segment);
  observe_tracks(0);
  detect_tracks();
  state_.posed = 0;
  const StartOutcome outcome = bootstrap_.attempt(&state_, id, &window_, &growth_, &poses_);
  if (counts_.started == 0) start_.note_outcome(outcome, state_.tracks.size());
  if (outcome == StartOutcome::kRotationOnly) ++counts_.rotation_only;
  if (outcome != StartOutcome::kStarted) return;
  state_.initialised = true;
  state_.median_depth = 1;
  lost_in_row_ = 0;
  if (++counts_.started == 1 && start_.two_eyes()) remark_ = kTwoEyes;
  note_motion(id);
  revive_.store_patches(state_, front_end_.current(), id, &patches_);
  unkept_ = id;
}

void Mapper::keep_place() {
  if (unkept_ < 0) return;
  places_.keep(look(unkept_));
  unkept_ = -1;
}

Places::Look Mapper::look(int32_t id) const {
  return {state_, front_end_.gray(), front_end_.current(), patches_, id};
}

void Mapper::track(int32_t id) {
  if (zoom_.see_keyframe(state_, id, frame_)) tell_zoom(zoom_.begin());
  const FramePose found = poses_.solve_new(state_, id);
  if (found.good) {
    take_pose(id, found);
  } else {
    lose(id);
  }
}

void Mapper::take_pose(int32_t id, const FramePose& first) {
  FramePose found = first;
  Keyframe& newest = state_.map.push_keyframe(id, state_.segment);
  newest.pose = found.pose;
  newest.posed = true;
  ++state_.posed;
  if (lost_in_row_ > 0) recover(id - 1, found.pose);
  lost_in_row_ = 0;
  // A zoom changes the size of what patches show.
  if (!zoom_.suspects() &&
      remeasure_.run(patches_, front_end_.current(), newest.pose, &state_) > 0) {
    found = poses_.refine(state_, newest.pose);
    newest.pose = found.pose;
  }
  observe_tracks(0);
  mark_outliers(&state_, id, 2 * kInlierGate);
  const size_t before = state_.tracks.size();
  const int revived = revive_.run(patches_, front_end_.current(), newest.pose, id,
                                  front_end_.flow(), front_end_.fresh_mask(), &state_);
  if (revived > 0) {
    observe_tracks(before);
    found = poses_.refine(state_, newest.pose);
    newest.pose = found.pose;
    mark_outliers(&state_, id, 2 * kInlierGate);
  }
  newest.center_sigma = found.center_sigma;
  detect_tracks();
  growth_.run(&state_, id, loses_much_);
  turns_.see_keyframe(state_, id);
  if (turns_.guessed(id, id)) tell_turn();
  adjust_window(id);
  note_motion(id);
  revive_.store_patches(state_, front_end_.current(), id, &patches_);
  unkept_ = id;
  adjust_whole(id);
}

void Mapper::adjust_whole(int32_t id) {
  if (state_.config.adjust_every == 0 || background_.running()) return;
  if (join(id) || state_.early()) return;
  const int32_t held = std::min(state_.posed, static_cast<int32_t>(state_.map.ids().size()));
  const int32_t gap = std::max(state_.config.adjust_every, held / kWholeGapShare);
  const bool loop = places_.loops().waiting(state_.segment);
  if (state_.posed < adjusted_posed_ + (loop ? kLoopGap : gap)) return;
  adjusted_posed_ = state_.posed;
  places_.loops().take(state_, &loops_);
  joining_ = false;
  background_.start(state_, id, loop ? kLoopIterations : kWholeIterations, &loops_, joined_ids_);
}

bool Mapper::join(int32_t id) {
  SegmentJoin found;
  if (!places_.take_join(state_, &found, &loops_)) return false;
  const int32_t present = state_.segment;
  const bool older = found.segment < present;
  const int32_t from = older ? present : found.segment;
  int32_t others = 0;
  joined_ids_.clear();
  for (const int32_t k : state_.map.ids()) {
    const Keyframe& held = state_.map.keyframe(k);
    if (held.posed && held.segment == from) joined_ids_.push_back(k);
    others += held.posed && held.segment == found.segment ? 1 : 0;
  }
  // The larger one knows the camera better.
  if (others > state_.posed) state_.intrinsics = lost_intrinsics_;
  places_.loops().forget(from);
  join_segments(&state_, from, older ? found.segment : present,
                older ? found.move.inverse() : found.move);
  adjusted_posed_ = state_.posed;
  joining_ = true;
  background_.start(state_, id, kFinalIterations, &loops_, joined_ids_);
  return true;
}

void Mapper::adjust_window(int32_t id) {
  const bool early = state_.early();
  const size_t most = early ? kMaxEarlyWindow : static_cast<size_t>(state_.config.window_size);
  window_ids_.clear();
  for (int32_t k = id; k >= 0 && window_ids_.size() < most; k = state_.posed_before(k)) {
    window_ids_.push_back(k);
  }
  std::reverse(window_ids_.begin(), window_ids_.end());
  window_.build(state_, window_ids_.data(), window_ids_.size());
  window_.solve(early ? kEarlyIterations : kWindowIterations, kWindowTolerance);
  window_.write_back(&state_);
  cull(&state_, window_ids_.data(), window_ids_.size(), kInlierGate);
}

void Mapper::note_motion(int32_t id) {
  const CameraPose& pose = state_.map.keyframe(id).pose;
  const int32_t last = state_.posed_before(id);
  if (last >= 0) {
    const CameraPose& before = state_.map.keyframe(last).pose;
    const double baseline = (pose.center() - before.center()).norm();
    if (angle_between(pose.R, before.R) > kTurnRad &&
        baseline < kTurnBaseline * state_.median_depth) {
      ++counts_.rotation_only;
    }
  }
  for (const int32_t k : state_.map.ids()) {
    const Keyframe& first = state_.map.keyframe(k);
    if (!first.posed || first.segment != state_.segment) continue;
    state_.intrinsics.note_rotation(angle_between(pose.R, first.pose.R));
    break;
  }
}

FramePose Mapper::frame_pose() {
  if (!state_.initialised) return {};
  return poses_.solve_new(state_, state_.map.end_id());
}

double Mapper::window_sigma(const int32_t* ids, size_t count) {
  window_.build(state_, ids, count);
  const BundlePrecision precision = window_.precision(ids, count);
  return precision.valid && std::isfinite(precision.center_sigma) ? precision.center_sigma : 0;
}

bool Mapper::finish() {
  keep_place();
  bool changed = background_.running() && background_.merge(&state_, &poses_);
  places_.finish(state_);
  if (!state_.initialised || state_.config.adjust_every == 0) return changed;
  const int32_t newest = state_.posed_before(state_.map.end_id());
  if (newest >= 0 && join(newest)) changed = background_.merge(&state_, &poses_) || changed;
  for (int round = 0; newest >= 0 && round < kFinalRounds; ++round) {
    places_.loops().take(state_, &loops_);
    background_.start(state_, newest, kFinalIterations, &loops_, joined_ids_);
    changed = background_.merge(&state_, &poses_) || changed;
  }
  turns_.settle(state_);
  return changed;
}

int64_t Mapper::bytes() const {
  const auto tracks = static_cast<int64_t>(state_.tracks.point.capacity());
  return state_.map.bytes() + patches_.bytes() + atlas_.bytes() + places_.bytes() +
         revive_.bytes() + remeasure_.bytes() + lost_tracks_.bytes() + window_.bytes() +
         background_.bytes() + front_end_.bytes() +
         tracks * static_cast<int64_t>(3 * sizeof(cv::Point2f) + sizeof(int32_t) + 1);
}

}  // namespace unisim::geometric
