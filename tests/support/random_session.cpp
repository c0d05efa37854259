// SPDX-License-Identifier: MIT
// A driver of sessions by random calls: sane ones, late ones, wrong ones.
#include "tests/support/random_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace unisim::test {

RandomCaller::RandomCaller(unisim_session* session, const unisim_config& config, uint32_t seed,
                           const Habits& habits)
    : session_(session),
      config_(config),
      habits_(habits),
      random_(seed),
      depth_(static_cast<size_t>(kWidth * kHeight)),
      maps_(UNISIM_MAX_VIEWS, {depth_.data(), nullptr, kWidth, kHeight}),
      poses_(UNISIM_MAX_VIEWS),
      ids_(UNISIM_MAX_VIEWS),
      ratios_(UNISIM_MAX_VIEWS),
      trajectory_(static_cast<size_t>(config.max_keyframes)),
      counts_(16) {
  for (float& depth : depth_) depth = static_cast<float>(1.0 + uniform_(random_));
}

int32_t RandomCaller::below(int32_t end) {
  return std::min(static_cast<int32_t>(uniform_(random_) * end), end - 1);
}

/// Overwrite eight random bytes behind struct_size: pointers and sizes are spared by the callers.
void RandomCaller::spoil(void* bytes, size_t size) {
  if (!chance(habits_.garbage)) return;
  const uint64_t garbage = (static_cast<uint64_t>(random_()) << 32) | random_();
  const auto place = static_cast<size_t>(below(static_cast<int32_t>(size - sizeof garbage + 1)));
  std::memcpy(static_cast<unsigned char*>(bytes) + place, &garbage, sizeof garbage);
}

unisim_sim3 RandomCaller::pose(double length) {
  double q[4] = {0.0, 0.0, 0.0, 1.0};
  double norm = 0.0;
  for (double& value : q) value += 0.2 * habits_.noise * (uniform_(random_) - 0.5);
  for (const double value : q) norm += value * value;
  unisim_sim3 T = {};
  for (int k = 0; k < 4; ++k) T.q[k] = q[k] / std::sqrt(norm);
  for (double& value : T.t) value = habits_.noise * (uniform_(random_) - 0.5);
  T.t[2] += length;
  T.s = 1.0;
  spoil(&T, sizeof T);
  return T;
}

void RandomCaller::fill_depth() {
  const auto unit = static_cast<float>(0.7 + 0.6 * uniform_(random_));
  for (float& depth : depth_) depth = std::min(std::max(depth * unit, 1e-3F), 1e3F);
  if (chance(habits_.garbage)) spoil(depth_.data(), depth_.size() * sizeof depth_[0]);
}

bool RandomCaller::add_keyframe() {
  unisim_keyframe keyframe = {};
  keyframe.struct_size = sizeof keyframe;
  keyframe.timestamp_ns = keyframes_;
  int32_t id = -1;
  const unisim_status status = unisim_add_keyframe(session_, &keyframe, &id);
  note(status);
  if (status == UNISIM_OK) ++keyframes_;
  if (keyframes_ > 1 && habits_.metres > 0.0 && chance(habits_.metres)) add_metres();
  return status != UNISIM_ERR_CAPACITY && status != UNISIM_ERR_INTERNAL;
}

void RandomCaller::add_pair(const unisim_request& request) {
  unisim_two_view pair = {};
  pair.struct_size = sizeof pair;
  pair.i = request.keyframe_ids[0];
  pair.j = request.keyframe_ids[1];
  pair.T_i_j = pose(0.1);
  pair.center_sigma = chance(0.5) ? 0.0 : 0.002 * uniform_(random_);
  fill_depth();
  pair.depth_i = maps_[0];
  pair.depth_j = maps_[0];
  if (chance(habits_.garbage)) pair.i = below(200) - 100;
  note(unisim_add_two_view(session_, &pair));
}

unisim_submap RandomCaller::submap(int32_t count) {
  for (int32_t k = 0; k < count; ++k) poses_[static_cast<size_t>(k)] = pose(0.1 * k);
  fill_depth();
  unisim_submap s = {};
  s.struct_size = sizeof s;
  s.count = count;
  s.keyframe_ids = ids_.data();
  s.T_submap_kf = poses_.data();
  s.depth = maps_.data();
  s.center_sigma = chance(0.3) ? 0.0 : 0.006 * uniform_(random_);
  if (chance(habits_.garbage)) ids_[static_cast<size_t>(below(count))] = below(2000) - 1000;
  return s;
}

void RandomCaller::add_window(const unisim_request& request) {
  int32_t count = 0;
  for (int32_t k = 0; k < request.count; ++k) {
    if (chance(0.05)) continue;  // a view the predictor lost
    ids_[static_cast<size_t>(count++)] = request.keyframe_ids[k];
  }
  if (count < 2) return;
  const unisim_submap s = submap(count);
  int32_t id = -1;
  note(unisim_add_submap(session_, &s, &id));
  submaps_ = std::max(submaps_, id + 1);
}

void RandomCaller::add_loop() {
  const int32_t half = std::min(config_.window_size / 2, 4);
  if (half < 1 || keyframes_ < 4 * half) return;
  const int32_t first = below(keyframes_ - 3 * half);
  const int32_t second = first + half + below(keyframes_ - first - 2 * half);
  for (int32_t k = 0; k < half; ++k) {
    ids_[static_cast<size_t>(k)] = first + k;
    ids_[static_cast<size_t>(half + k)] = second + k;
  }
  const unisim_submap s = submap(2 * half);
  int32_t id = -1;
  note(unisim_add_loop(session_, &s, &id));
  submaps_ = std::max(submaps_, id + 1);
}

void RandomCaller::update() {
  if (submaps_ == 0) return;
  unisim_submap_info info = {};
  info.struct_size = sizeof info;
  const int32_t id = below(submaps_);
  note(unisim_get_submap(session_, id, &info));
  unisim_submap_update u = {};
  u.struct_size = sizeof u;
  u.submap_id = chance(habits_.garbage) ? below(200) - 100 : id;
  u.count = info.count;
  for (int32_t k = 0; k < info.count; ++k) {
    poses_[static_cast<size_t>(k)] = pose(0.1 * k);
    ratios_[static_cast<size_t>(k)] = 0.1 * (uniform_(random_) - 0.5);
  }
  if (chance(habits_.garbage)) spoil(ratios_.data(), ratios_.size() * sizeof ratios_[0]);
  u.T_submap_kf = poses_.data();
  u.log_depth_ratio = ratios_.data();
  u.center_sigma = 0.006 * uniform_(random_);
  note(unisim_update_submap(session_, &u));
}

void RandomCaller::add_metres() {
  unisim_distance d = {};
  d.struct_size = sizeof d;
  d.j = std::max(0, keyframes_ - 1 - below(8));
  d.i = std::max(0, d.j - 1 - below(chance(0.1) ? 100 : 8));
  d.source = below(4);
  d.metres = 0.1 + 10.0 * uniform_(random_);
  d.sigma = 0.02 * d.metres;
  d.common_sigma = chance(0.5) ? 0.01 : 0.0;
  if (chance(habits_.garbage)) spoil(&d.i, sizeof d - sizeof d.struct_size);
  note(unisim_add_distance(session_, &d));
  unisim_submap_unit u = {};
  u.struct_size = sizeof u;
  u.submap_id = below(submaps_ + 2) - 1;
  u.source = UNISIM_METRIC_MODEL;
  u.metres = 0.5 + uniform_(random_);
  u.sigma = 0.1;
  if (chance(habits_.garbage)) spoil(&u.submap_id, sizeof u - sizeof u.struct_size);
  if (chance(0.1)) note(unisim_add_submap_unit(session_, &u));
  unisim_scale scale = {};
  scale.struct_size = sizeof scale;
  note(unisim_get_scale(session_, below(3) - 1, &scale));
}

void RandomCaller::read() {
  unisim_pose pose = {};
  pose.struct_size = sizeof pose;
  note(unisim_get_pose(session_, below(keyframes_ + 2) - 1, &pose));
  size_t count = 0;
  trajectory_[0].struct_size = sizeof trajectory_[0];
  note(unisim_get_trajectory(session_, trajectory_.data(), trajectory_.size(), &count));
  double covariance[49];
  note(unisim_get_covariance(session_, below(keyframes_ + 2) - 1, covariance));
  const int32_t asked = below(keyframes_ + 2) - 1;
  note(unisim_multiply_covariance(session_, asked, 1 + below(3), covariance, covariance + 21));
  unisim_retired retired = {};
  retired.struct_size = sizeof retired;
  for (int k = 0; k < 20 && unisim_next_retired(session_, &retired) == UNISIM_OK; ++k) {
  }
  unisim_loop_info loop = {};
  loop.struct_size = sizeof loop;
  note(unisim_get_loop(session_, below(submaps_ + 2) - 1, &loop));
  if (chance(0.1)) note(unisim_remove_loop(session_, below(submaps_ + 2) - 1));
}

void RandomCaller::optimize() {
  unisim_budget budget = {sizeof budget, 1 + below(3)};
  const unisim_status status = unisim_optimize(session_, &budget, nullptr);
  note(status);
  if (status == UNISIM_ERR_CAPACITY) ++solver_overflows_;
}

void RandomCaller::answer_request() {
  unisim_request request = {};
  request.struct_size = sizeof request;
  const uint32_t kinds =
      chance(0.5) ? UNISIM_REQUEST_PAIR | UNISIM_REQUEST_WINDOW : UNISIM_REQUEST_PAIR;
  const unisim_status status = unisim_next_request(session_, kinds, &request);
  note(status);
  if (status != UNISIM_OK) return;
  if (chance(habits_.reject)) {
    spoil(&request.kind, sizeof request - sizeof request.struct_size);
    note(unisim_reject_request(session_, &request));
  } else if (request.kind == UNISIM_REQUEST_PAIR) {
    add_pair(request);
  } else {
    add_window(request);
  }
}

bool RandomCaller::step() {
  const int32_t dice = below(100);
  if (keyframes_ >= habits_.keyframes) return false;
  if (dice < 25) return add_keyframe();
  if (dice < 80) {
    answer_request();
  } else if (dice < 82) {
    add_loop();
  } else if (dice < 85) {
    update();
  } else if (dice < 95) {
    if (chance(habits_.reads)) read();
  } else if (dice < 99) {
    if (chance(habits_.optimizes)) optimize();
  } else {
    note(unisim_close_window(session_));
  }
  return true;
}

}  // namespace unisim::test
