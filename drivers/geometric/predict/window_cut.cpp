// SPDX-License-Identifier: MIT
// Windows of keyframes cut out of the running state, and their revisions when the state improves.
#include "drivers/geometric/predict/window_cut.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "drivers/common/median.hpp"

namespace unisim::geometric {

namespace {
// Changes worth a revision: of the median depth, in rad and of log depth.
constexpr double kNoticeable = 1e-4;
constexpr double kNoticeableInPassing =
    5e-4;  // where the next adjustment of all will say it better
constexpr int64_t kNewestWindows = 2;

double depth_of(const State& state, int32_t keyframe, int32_t index, uint32_t* owner) {
  const Observation& seen = state.map.observation(keyframe, index);
  if (seen.landmark < 0) return 0;
  const Landmark& mark = state.map.landmark(seen.landmark);
  if (mark.state != LandmarkState::kPlaced || mark.soft) return 0;
  *owner = mark.generation;
  const double depth = state.map.keyframe(keyframe).pose.apply(mark.position).z();
  return depth > kMinDepth ? depth : 0;
}

}  // namespace

unisim_sim3 to_sim3(const CameraPose& pose) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::Matrix3d(pose.R.transpose())).normalized();
  const Eigen::Vector3d c = pose.center();
  return {{q.x(), q.y(), q.z(), q.w()}, {c.x(), c.y(), c.z()}, 1.0};
}

unisim_sim3 relative_sim3(const CameraPose& i, const CameraPose& j) {
  CameraPose j_from_i;  // takes points of camera i to camera j
  j_from_i.R = j.R * i.R.transpose();
  j_from_i.t = j.t - j_from_i.R * i.t;
  return to_sim3(j_from_i);
}

WindowCut::WindowCut(size_t max_views, size_t observations_per_keyframe)
    : views_(max_views),
      depths_(max_views * observations_per_keyframe),
      owners_(max_views * observations_per_keyframe),
      windows_(max_views / 2 + 1),
      per_view_(observations_per_keyframe) {
  scratch_.reserve(observations_per_keyframe);
}

void WindowCut::record(const State& state, int32_t keyframe, int64_t view) {
  const Keyframe& from = state.map.keyframe(keyframe);
  View& slot = views_[place(view)];
  slot.keyframe = keyframe;
  slot.pose = from.pose;
  const size_t base = place(view) * per_view_;
  for (size_t i = 0; i < per_view_; ++i) {
    uint32_t owner = 0;
    const bool used = static_cast<int32_t>(i) < from.observations;
    depths_[base + i] =
        used ? static_cast<float>(depth_of(state, keyframe, static_cast<int32_t>(i), &owner)) : 0;
    owners_[base + i] = owner;
  }
}

int64_t WindowCut::give(const State& state, const int32_t* ids, size_t count, double center_sigma) {
  const int64_t token = end_token_++;
  Window& window = windows_[static_cast<size_t>(token) % windows_.size()];
  window = {token, end_view_, count, center_sigma};
  for (size_t i = 0; i < count; ++i) record(state, ids[i], end_view_++);
  const auto capacity = static_cast<int64_t>(views_.size());
  const auto most = static_cast<int64_t>(windows_.size());
  while (end_token_ - oldest_ > most ||
         end_view_ - windows_[static_cast<size_t>(oldest_) % windows_.size()].first_view >
             capacity) {
    ++oldest_;
  }
  next_ = std::max(next_, oldest_);
  return token;
}

/// All views are still held, in one segment: which may be another one than then, since joined.
bool WindowCut::measurable(const State& state, const Window& window) const {
  const int32_t first = views_[place(window.first_view)].keyframe;
  for (size_t i = 0; i < window.count; ++i) {
    const View& view = views_[place(window.first_view + static_cast<int64_t>(i))];
    if (!state.map.holds(view.keyframe)) return false;
    const Keyframe& from = state.map.keyframe(view.keyframe);
    if (!from.posed || from.segment != state.map.keyframe(first).segment) return false;
  }
  return true;
}

double WindowCut::log_depth_ratio(const State& state, int64_t view) {
  const int32_t keyframe = views_[place(view)].keyframe;
  const size_t base = place(view) * per_view_;
  scratch_.clear();
  for (int32_t i = 0; i < state.map.keyframe(keyframe).observations; ++i) {
    const auto at = base + static_cast<size_t>(i);
    uint32_t owner = 0;
    const double depth = depth_of(state, keyframe, i, &owner);
    if (depth > 0 && depths_[at] > 0 && owner == owners_[at]) {
      scratch_.push_back(std::log(depth / static_cast<double>(depths_[at])));
    }
  }
  if (scratch_.empty()) return 0;
  return drivers::median(&scratch_);
}

bool WindowCut::changed(const State& state, const Window& window,
                        const std::vector<double>& ratios) const {
  const auto center_view = static_cast<size_t>(window.count / 2);
  const View& center = views_[place(window.first_view + static_cast<int64_t>(center_view))];
  const CameraPose& center_now = state.map.keyframe(center.keyframe).pose;
  const double unit = state.median_depth > 0 ? state.median_depth : 1;
  const double scale = std::exp(ratios[center_view]);
  double most = 0;
  for (size_t i = 0; i < window.count; ++i) {
    const View& view = views_[place(window.first_view + static_cast<int64_t>(i))];
    const CameraPose& now = state.map.keyframe(view.keyframe).pose;
    const Eigen::Vector3d offset = center.pose.apply(view.pose.center());
    const Eigen::Vector3d offset_now = center_now.apply(now.center());
    const Eigen::Matrix3d turn = view.pose.R * center.pose.R.transpose();
    const Eigen::Matrix3d turn_now = now.R * center_now.R.transpose();
    most = std::max({most, (offset_now / scale - offset).norm() / unit, (turn_now - turn).norm(),
                     std::abs(ratios[i] - ratios[center_view])});
  }
  return most > noticeable_;
}

void WindowCut::look_again_at_all() {
  next_ = oldest_;
  noticeable_ = kNoticeable;
}

void WindowCut::look_again_at_newest() {
  if (next_ < end_token_) return;  // a look at all is not finished
  next_ = std::max(oldest_, end_token_ - kNewestWindows);
  noticeable_ = kNoticeableInPassing;
}

bool WindowCut::next_revision(const State& state, WindowRevision* out) {
  for (; next_ < end_token_; ++next_) {
    Window& window = windows_[static_cast<size_t>(next_) % windows_.size()];
    if (!measurable(state, window)) continue;
    out->log_depth_ratio.clear();
    for (size_t i = 0; i < window.count; ++i) {
      out->log_depth_ratio.push_back(
          log_depth_ratio(state, window.first_view + static_cast<int64_t>(i)));
    }
    if (!changed(state, window, out->log_depth_ratio)) continue;
    out->token = window.token;
    out->first = views_[place(window.first_view)].keyframe;
    out->last = views_[place(window.first_view + static_cast<int64_t>(window.count) - 1)].keyframe;
    out->center_sigma = window.center_sigma;
    out->poses.clear();
    for (size_t i = 0; i < window.count; ++i) {
      const int64_t view = window.first_view + static_cast<int64_t>(i);
      const int32_t keyframe = views_[place(view)].keyframe;
      out->poses.push_back(to_sim3(state.map.keyframe(keyframe).pose));
      record(state, keyframe, view);
    }
    ++next_;
    return true;
  }
  return false;
}

int64_t WindowCut::bytes() const {
  return static_cast<int64_t>(
      views_.capacity() * sizeof(View) + depths_.capacity() * sizeof(float) +
      owners_.capacity() * sizeof(uint32_t) + windows_.capacity() * sizeof(Window));
}

}  // namespace unisim::geometric
