// SPDX-License-Identifier: MIT
// A scripted camera path, source and predictor.
#include "tests/pipeline/scripted_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drivers/pipeline/similarity.hpp"

namespace unisim::testing {
namespace {

constexpr int32_t kWidth = 16;
constexpr int32_t kHeight = 12;
constexpr int64_t kFrameNs = 33333333;

unisim_sim3 inverse(const unisim_sim3& T) {
  const unisim_sim3 turn = {{-T.q[0], -T.q[1], -T.q[2], T.q[3]}, {0, 0, 0}, 1.0};
  const unisim_sim3 back = {{0, 0, 0, 1}, {-T.t[0], -T.t[1], -T.t[2]}, 1.0};
  return pipeline::compose(turn, back);
}

}  // namespace

unisim_sim3 true_pose(int64_t index) {
  const double a = 0.01 * static_cast<double>(index);
  const double half = 0.3 * std::sin(a) / 2.0;
  return {{0.0, std::sin(half), 0.0, std::cos(half)},
          {std::sin(2.0 * a), 0.2 * std::sin(3.0 * a), 0.5 * a},
          1.0};
}

unisim_sim3 relative_pose(const unisim_sim3& a, const unisim_sim3& b, double unit) {
  unisim_sim3 T = pipeline::compose(inverse(a), b);
  for (double& part : T.t) part *= unit;
  return T;
}

ScriptedSource::ScriptedSource(int64_t count)
    : count_(count), pixels_(size_t{2} * kWidth * kHeight) {
  handle_.self = this;
  unisim_source& t = handle_.table;
  t.struct_size = sizeof t;
  t.format = "scripted";
  t.frame_count = [](unisim_source* s) { return self(s)->count_; };
  t.next_frame = [](unisim_source* s, int, unisim_frame* frame) { return self(s)->next(frame); };
  t.interrupt = [](unisim_source* s) {
    if (self(s)->on_interrupt) self(s)->on_interrupt();
  };
  t.ground_truth = [](unisim_source*, const unisim_stamped_pose**) { return int64_t{0}; };
  t.ground_truth_path = [](unisim_source*) { return ""; };
  t.message = [](unisim_source* s) { return self(s)->message_.c_str(); };
  t.destroy = [](unisim_source*) {};
}

ScriptedSource* ScriptedSource::self(unisim_source* source) {
  return reinterpret_cast<Handle*>(source)->self;
}

int ScriptedSource::next(unisim_frame* frame) {
  if (next_ >= count_) return UNISIM_FRAME_END;
  const int64_t index = next_++;
  if (before_frame) before_frame(index);
  message_ = "frame " + std::to_string(index) + ": scripted";
  if (index == fails_at) return UNISIM_FRAME_FAILED;
  if (bad.count(index) != 0) return UNISIM_FRAME_BAD;
  pixels_.assign(pixels_.size(), static_cast<uint8_t>(index));
  const int64_t time = repeated_time.count(index) != 0 ? index - 1 : index;
  const int32_t height = resized.count(index) != 0 ? kHeight - 1 : kHeight;
  *frame = {
      index, time * kFrameNs, {pixels_.data(), kWidth, height, 2 * kWidth, UNISIM_PIXEL_GRAY8}};
  return UNISIM_FRAME_OK;
}

ScriptedPredictor::ScriptedPredictor() {
  handle_.self = this;
  unisim_predictor& t = handle_.table;
  t.struct_size = sizeof t;
  t.name = "scripted";
  t.needs_images = 1;
  t.observe = [](unisim_predictor* p, const unisim_frame* f, unisim_motion* m) {
    return self(p)->observe(f, m);
  };
  t.keyframe = [](unisim_predictor* p, const unisim_frame* f, int32_t id) {
    if (self(p)->before_keyframe) self(p)->before_keyframe(id);
    const std::lock_guard<std::mutex> lock(self(p)->mutex_);
    const bool in_order = id == static_cast<int32_t>(self(p)->keyframes.size());
    self(p)->keyframes.push_back(f->index);
    return in_order ? UNISIM_PREDICTION_OK : UNISIM_PREDICTION_FAILED;
  };
  t.two_view = [](unisim_predictor* p, int32_t i, int32_t j, unisim_pair_prediction* out) {
    return self(p)->two_view(i, j, out);
  };
  t.multi_view = [](unisim_predictor* p, const int32_t* ids, int32_t count,
                    unisim_window_prediction* out) { return self(p)->multi_view(ids, count, out); };
  t.next_revision = [](unisim_predictor* p, unisim_window_revision* out) {
    return self(p)->next_revision(out);
  };
  t.next_wide_window = [](unisim_predictor* p, int32_t max_views, unisim_window_prediction* out) {
    return self(p)->next_wide_window(max_views, out);
  };
  t.frame_pose = [](unisim_predictor* p, unisim_frame_pose* out) {
    return self(p)->frame_pose(out);
  };
  t.save_map = [](unisim_predictor* p, unisim_map_write write, void* context) {
    return self(p)->save_map(write, context);
  };
  t.load_map = [](unisim_predictor* p, unisim_map_read read, void* context, int32_t* next) {
    return self(p)->load_map(read, context, next);
  };
  // Every seventh frame shows something else.
  t.locate = [](unisim_predictor* p, const unisim_frame* frame, unisim_location* out) {
    if (frame->index % 7 == 3) return UNISIM_PREDICTION_REJECTED;
    *out = {true_pose(frame->index), self(p)->keyframes_now() / 2, 0, 45, 60, 0, 0};
    return UNISIM_PREDICTION_OK;
  };
  t.map_pose = [](unisim_predictor* p, int32_t id, unisim_map_pose* out) {
    *out = {true_pose(self(p)->keyframe_frame(id)), 0, 0};
    return UNISIM_PREDICTION_OK;
  };
  t.finish = [](unisim_predictor* p) {
    self(p)->finished_ = true;
    return UNISIM_PREDICTION_OK;
  };
  t.info = [](unisim_predictor* p, unisim_predictor_info* out) {
    const std::string& why = self(p)->no_start;
    *out = {};
    out->initialised = why.empty() ? 1 : 0;
    out->no_start = why.empty() ? nullptr : why.c_str();
    if (!why.empty()) return;
    out->focal_px = 500.0;
    out->focal_sigma_px = self(p)->focal_sigma_px;
  };
  t.message = [](unisim_predictor* p) { return self(p)->message_.c_str(); };
  t.window_message = t.message;
  t.destroy = [](unisim_predictor*) {};
}

ScriptedPredictor* ScriptedPredictor::self(unisim_predictor* predictor) {
  return reinterpret_cast<Handle*>(predictor)->self;
}

int32_t ScriptedPredictor::keyframes_now() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int32_t>(keyframes.size());
}

int64_t ScriptedPredictor::keyframe_frame(int32_t keyframe) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return keyframes.at(static_cast<size_t>(keyframe));
}

double ScriptedPredictor::pair_unit(int32_t i) { return std::ldexp(1.0, (i * 5) % 4 - 1); }

double ScriptedPredictor::window_unit(int32_t first) { return std::ldexp(1.0, first % 3 - 1); }

unisim_depth_map ScriptedPredictor::depth_of(int32_t keyframe, double unit,
                                             std::vector<float>* storage) const {
  storage->resize(size_t{kWidth} * kHeight);
  for (size_t k = 0; k < storage->size(); ++k) {
    const double wave = std::sin(0.1 * static_cast<double>(k) + keyframe);
    (*storage)[k] = static_cast<float>(2.0 + 0.5 * wave) * static_cast<float>(unit);
  }
  return {storage->data(), nullptr, kWidth, kHeight};
}

int ScriptedPredictor::observe(const unisim_frame* frame, unisim_motion* motion) {
  ++observed;
  if (frame->index == fails_at) return UNISIM_PREDICTION_FAILED;
  const unisim_image& image = frame->image;
  if (image.data == nullptr || image.data[0] != static_cast<uint8_t>(frame->index)) ++moved_off;
  newest_frame_ = frame->index;
  const int64_t since = keyframes.empty() ? 0 : frame->index - keyframes.back();
  const auto reason = reasons.find(frame->index);
  *motion = {flow * static_cast<double>(since), -1.0, 0,
             reason != reasons.end() ? reason->second : UNISIM_REASON_NONE};
  return UNISIM_PREDICTION_OK;
}

int ScriptedPredictor::two_view(int32_t i, int32_t j, unisim_pair_prediction* out) {
  if (static_cast<int32_t>(keyframes.size()) < pending_until) return UNISIM_PREDICTION_PENDING;
  if (starts_at_end && !finished_) return UNISIM_PREDICTION_PENDING;
  if (rejected_pairs.count(i) != 0) return UNISIM_PREDICTION_REJECTED;
  const double unit = pair_unit(i);
  *out = {};
  out->gap = i == found_again ? gap : 0;
  const int32_t from = i - out->gap;
  out->T_i_j = relative_pose(true_pose(keyframe_frame(from)), true_pose(keyframe_frame(j)), unit);
  out->depth_i = depth_of(from, unit, &depth_i_);
  out->depth_j = depth_of(j, unit, &depth_j_);
  if (guessed_pairs.count(i) != 0) out->log_scale_sigma = 0.5;
  if (nan_pairs.count(i) != 0) out->T_i_j.t[1] = std::numeric_limits<double>::quiet_NaN();
  if (empty_pairs.count(i) != 0) out->depth_j.width = 0;
  return UNISIM_PREDICTION_OK;
}

void ScriptedPredictor::fill_poses(double noise, double bend, Arrays* arrays) const {
  arrays->poses.clear();
  const int32_t first = arrays->ids[0];
  const unisim_sim3 origin = true_pose(keyframe_frame(first));
  for (const int32_t id : arrays->ids) {
    unisim_sim3 T = relative_pose(origin, true_pose(keyframe_frame(id)), window_unit(first));
    T.t[1] += noise * std::sin(5.0 * id) + bend * (id - first) * (id - first);
    arrays->poses.push_back(T);
  }
}

int ScriptedPredictor::multi_view(const int32_t* ids, int32_t count,
                                  unisim_window_prediction* out) {
  if (keyframes_now() < pending_until) return UNISIM_PREDICTION_PENDING;
  if (before_window) before_window(ids[0]);
  newest_asked_ = std::max(newest_asked_, ids[count - 1]);
  if (rejected_windows.count(ids[0]) != 0) return UNISIM_PREDICTION_REJECTED;
  if (failing_windows.count(ids[0]) != 0) return UNISIM_PREDICTION_FAILED;
  window_.ids.assign(ids, ids + count);
  fill_poses(window_noise, window_bend, &window_);
  if (nan_windows.count(ids[0]) != 0) {
    window_.poses.back().q[2] = std::numeric_limits<double>::quiet_NaN();
  }
  give_window(&window_, out);
  if (uncertain_windows.count(ids[0]) != 0) out->center_sigma = 0.5;
  out->token = ++next_token_;
  if (metres > 0.0) {
    out->metres_per_unit = metres / window_unit(ids[0]);
    out->metres_sigma = 0.1;
    out->metres_common_sigma = 0.05;
  }
  if (revises) open_revisions_.push_back({out->token, window_.ids});
  if (wrong_window_ids) window_.ids.back() += 1000;
  return UNISIM_PREDICTION_OK;
}

/// The window of the ids and poses in `arrays`.
void ScriptedPredictor::give_window(Arrays* arrays, unisim_window_prediction* out) const {
  arrays->maps.clear();
  arrays->depths.resize(arrays->ids.size());
  for (size_t k = 0; k < arrays->ids.size(); ++k) {
    arrays->maps.push_back(
        depth_of(arrays->ids[k], window_unit(arrays->ids[0]), &arrays->depths[k]));
  }
  *out = {};
  out->token = -1;
  out->count = static_cast<int32_t>(arrays->ids.size());
  out->keyframe_ids = arrays->ids.data();
  out->T_window_kf = arrays->poses.data();
  out->depth = arrays->maps.data();
}

int ScriptedPredictor::next_wide_window(int32_t max_views, unisim_window_prediction* out) {
  if (wide_every == 0) return UNISIM_PREDICTION_PENDING;
  // The newest keyframe's pair may still be open; on two threads only what was asked for counts.
  const bool concurrent = handle_.table.concurrent_windows != 0;
  const int32_t settled = concurrent ? newest_asked_ : keyframes_now() - 1;
  if (settled / wide_every <= wide_given) return UNISIM_PREDICTION_PENDING;
  wide_given = settled / wide_every;  // only the newest state is there to be cut from
  wide_.ids.clear();
  for (int32_t id = 0; id < settled; id += settled / max_views + 1) wide_.ids.push_back(id);
  fill_poses(0.0, 0.0, &wide_);
  give_window(&wide_, out);
  return UNISIM_PREDICTION_OK;
}

int ScriptedPredictor::next_revision(unisim_window_revision* out) {
  if ((!finished_ && !revises_early) || open_revisions_.empty()) return UNISIM_PREDICTION_PENDING;
  const Window window = open_revisions_.back();
  open_revisions_.pop_back();
  revision_.ids = window.ids;
  fill_poses(0.0, 0.0, &revision_);
  log_ratios_.assign(window.ids.size(), 0.0);
  *out = {window.token,
          static_cast<int32_t>(window.ids.size()),
          revision_.poses.data(),
          log_ratios_.data(),
          0.0,
          0,
          0};
  return UNISIM_PREDICTION_OK;
}

int ScriptedPredictor::frame_pose(unisim_frame_pose* out) {
  const auto newest = static_cast<int32_t>(keyframes.size()) - 1;
  if (newest < 1) return UNISIM_PREDICTION_PENDING;
  out->keyframe_id = newest;
  out->T_kf_frame =
      relative_pose(true_pose(keyframes.back()), true_pose(newest_frame_), pair_unit(newest - 1));
  return UNISIM_PREDICTION_OK;
}

/// The frames of the keyframes, their number first.
int ScriptedPredictor::save_map(unisim_map_write write, void* context) const {
  const auto count = static_cast<int64_t>(keyframes.size());
  const bool all = write(context, &count, sizeof count) != 0 &&
                   write(context, keyframes.data(), keyframes.size() * sizeof keyframes[0]) != 0;
  return all ? UNISIM_PREDICTION_OK : UNISIM_PREDICTION_REJECTED;
}

int ScriptedPredictor::load_map(unisim_map_read read, void* context, int32_t* next_keyframe) {
  int64_t count = 0;
  if (read(context, &count, sizeof count) == 0) return UNISIM_PREDICTION_REJECTED;
  keyframes.resize(static_cast<size_t>(count));
  const bool all = read(context, keyframes.data(), keyframes.size() * sizeof keyframes[0]) != 0;
  *next_keyframe = static_cast<int32_t>(count);
  return all ? UNISIM_PREDICTION_OK : UNISIM_PREDICTION_REJECTED;
}

}  // namespace unisim::testing
