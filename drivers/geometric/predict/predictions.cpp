// SPDX-License-Identifier: MIT
// Turns the running state into the predictions of drivers/predictor.h.
#include "drivers/geometric/predict/predictions.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::geometric {

namespace {
// A pair is measured before later keyframes have improved it, and its window will say the same
// thing better: it is held loosely.
constexpr double kPairSigma = 0.003;
constexpr size_t kLeastWideViews = 3;
// Of log scale after a turn on the spot: what is new there was guessed at up to 1.7 times too near.
constexpr double kGuessedScaleSigma = 0.5;

/// Keyframe that stands in for i in the pair (i, j): the last one of j's segment where the track
/// was lost between and found again at j.
int32_t before_gap(const State& state, int32_t i, int32_t j) {
  const Keyframe& found = state.map.keyframe(j);
  const int32_t before = found.posed ? state.posed_before(i + 1, found.segment) : -1;
  return before >= 0 ? before : i;
}

bool finite(const unisim_sim3& pose) {
  double sum = 0;
  for (const double value : pose.q) sum += value;
  for (const double value : pose.t) sum += value;
  return std::isfinite(sum);
}

}  // namespace

Predictions::Predictions(const unisim_geometric_config& config, const cv::Size& image)
    : grid_size_(depth_grid_size(image)),
      windows_(static_cast<size_t>(config.max_window_views),
               static_cast<size_t>(config.max_tracks + config.revive_tries)) {
  grid_.reserve(grid_size_);
  const auto cells = static_cast<size_t>(grid_size_.area());
  for (auto* field : {&pair_maps_.depth, &pair_maps_.confidence}) field->resize(2 * cells);
  for (auto* field : {&window_maps_.depth, &window_maps_.confidence}) {
    field->resize(UNISIM_MAX_VIEWS * cells);
  }
  depths_.reserve(UNISIM_MAX_VIEWS);
  ids_.reserve(UNISIM_MAX_VIEWS);
  poses_.reserve(UNISIM_MAX_VIEWS);
  revision_.poses.reserve(UNISIM_MAX_VIEWS);
  revision_.log_depth_ratio.reserve(UNISIM_MAX_VIEWS);
}

unisim_depth_map Predictions::fill(const State& state, int32_t keyframe, size_t view, Maps* maps) {
  const size_t offset = view * static_cast<size_t>(grid_size_.area());
  float* depth = maps->depth.data() + offset;
  float* confidence = maps->confidence.data() + offset;
  grid_.run(state, keyframe, grid_size_, depth, confidence);
  return {depth, confidence, grid_size_.width, grid_size_.height};
}

int Predictions::pair(const Mapper& mapper, int32_t i, int32_t j, unisim_pair_prediction* out,
                      const char** why) {
  const State& state = mapper.state();
  if (!state.map.holds(i) || !state.map.holds(j)) {
    *why = "geometric: the pair's keyframes are no longer or not yet in the state";
    return UNISIM_PREDICTION_REJECTED;
  }
  const Keyframe& second = state.map.keyframe(j);
  const int32_t found_from = before_gap(state, i, j);
  const Keyframe& first = state.map.keyframe(found_from);
  if (!state.initialised && first.segment == state.segment && second.segment == state.segment) {
    *why = "geometric: no start found yet";
    return UNISIM_PREDICTION_PENDING;
  }
  const bool may_recover = !second.posed && j == state.map.end_id() - 1 && first.posed;
  if (may_recover && second.segment == state.segment && first.segment == state.segment) {
    *why = "geometric: the newest keyframe has no pose; the next one may give it";
    return UNISIM_PREDICTION_PENDING;
  }
  if (!first.posed || !second.posed || first.segment != second.segment) {
    *why = "geometric: track was lost between the pair's keyframes; a new segment begins";
    return UNISIM_PREDICTION_REJECTED;
  }
  out->T_i_j = relative_sim3(first.pose, second.pose);
  if (!finite(out->T_i_j)) {
    *why = "geometric: the pair's pose is not finite";
    return UNISIM_PREDICTION_REJECTED;
  }
  out->gap = i - found_from;
  out->depth_i = fill(state, found_from, 0, &pair_maps_);
  out->depth_j = fill(state, j, 1, &pair_maps_);
  out->focal_px = state.intrinsics.camera.focal_px;
  out->center_sigma = std::max(kPairSigma, second.center_sigma);
  out->log_scale_sigma = mapper.turns().guessed(j, j) ? kGuessedScaleSigma : 0;
  return UNISIM_PREDICTION_OK;
}

void Predictions::choose_views(const State& state, const int32_t* ids, int32_t count) {
  const auto usable = [&](int32_t id) {
    return state.map.holds(id) && state.map.keyframe(id).posed &&
           finite(to_sim3(state.map.keyframe(id).pose));
  };
  int32_t segment = -1;
  int32_t most = 0;
  for (int32_t a = 0; a < count; ++a) {
    if (!usable(ids[a])) continue;
    int32_t same = 0;
    for (int32_t b = 0; b < count; ++b) {
      same += usable(ids[b]) &&
              state.map.keyframe(ids[b]).segment == state.map.keyframe(ids[a]).segment;
    }
    if (same <= most) continue;
    most = same;
    segment = state.map.keyframe(ids[a]).segment;
  }
  ids_.clear();
  for (int32_t a = 0; a < count && ids_.size() < UNISIM_MAX_VIEWS; ++a) {
    if (usable(ids[a]) && state.map.keyframe(ids[a]).segment == segment) ids_.push_back(ids[a]);
  }
}

int Predictions::window(Mapper* mapper, const int32_t* ids, int32_t count,
                        unisim_window_prediction* out, const char** why) {
  const State& state = mapper->state();
  if (mapper->joining()) {
    *why = "geometric: two segments are being joined";
    return UNISIM_PREDICTION_PENDING;
  }
  choose_views(state, ids, count);
  if (ids_.size() < 2) {
    *why = "geometric: fewer than two of the window's keyframes have a pose";
    return UNISIM_PREDICTION_REJECTED;
  }
  cut_views(state, out);
  out->center_sigma = ids_.size() >= 3 ? mapper->window_sigma(ids_.data(), ids_.size()) : 0;
  out->token = windows_.give(state, ids_.data(), ids_.size(), out->center_sigma);
  remark_ = mapper->take_remark();
  if (!remark_.empty()) out->remark = remark_.c_str();
  return UNISIM_PREDICTION_OK;
}

/// The chosen views as they are in the state now.
void Predictions::cut_views(const State& state, unisim_window_prediction* out) {
  poses_.clear();
  depths_.clear();
  for (const int32_t id : ids_) {
    poses_.push_back(to_sim3(state.map.keyframe(id).pose));
    depths_.push_back(fill(state, id, depths_.size(), &window_maps_));
  }
  *out = {};
  out->count = static_cast<int32_t>(ids_.size());
  out->keyframe_ids = ids_.data();
  out->T_window_kf = poses_.data();
  out->depth = depths_.data();
  out->focal_px = state.intrinsics.camera.focal_px;
}

int Predictions::wide_window(const Mapper& mapper, int32_t max_views,
                             unisim_window_prediction* out) {
  const bool due = wide_is_due_;
  wide_is_due_ = false;
  const std::vector<int32_t>& spread = mapper.spread();
  if (!due || spread.empty() || !(mapper.spread_sigma() > 0)) return UNISIM_PREDICTION_PENDING;
  const size_t step = (spread.size() - 1) / static_cast<size_t>(std::max(max_views, 1)) + 1;
  ids_.clear();
  for (size_t i = 0; i < spread.size(); i += step) {
    if (spread[i] >= mapper.turns().firm_from()) ids_.push_back(spread[i]);
  }
  const std::vector<int32_t> wanted = ids_;
  choose_views(mapper.state(), wanted.data(), static_cast<int32_t>(wanted.size()));
  if (ids_.size() < kLeastWideViews) return UNISIM_PREDICTION_PENDING;
  cut_views(mapper.state(), out);
  out->center_sigma = mapper.spread_sigma();
  out->token = -1;
  return UNISIM_PREDICTION_OK;
}

int Predictions::revision(const Mapper& mapper, unisim_window_revision* out) {
  if (!windows_.next_revision(mapper.state(), &revision_)) return UNISIM_PREDICTION_PENDING;
  out->token = revision_.token;
  out->count = static_cast<int32_t>(revision_.poses.size());
  out->T_window_kf = revision_.poses.data();
  out->log_depth_ratio = revision_.log_depth_ratio.data();
  out->center_sigma = revision_.center_sigma;
  out->scale_settled = mapper.turns().guessed(revision_.first, revision_.last) ? 0 : 1;
  return UNISIM_PREDICTION_OK;
}

int64_t Predictions::bytes() const {
  const size_t floats = pair_maps_.depth.capacity() + pair_maps_.confidence.capacity() +
                        window_maps_.depth.capacity() + window_maps_.confidence.capacity();
  return static_cast<int64_t>(floats * sizeof(float)) + windows_.bytes();
}

}  // namespace unisim::geometric
