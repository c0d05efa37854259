// SPDX-License-Identifier: MIT
// A made-up camera run with exact predictions in random units, fed to a session through unisim.h.
#include "tests/capi/world.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/catch.hpp"

namespace unisim::test {
namespace {

constexpr int32_t kDepthWidth = 20;
constexpr int32_t kDepthHeight = 15;
constexpr double kRadius = 3.0;
constexpr double kPi = 3.14159265358979323846;

Sim3 on_circle(double angle) {
  Vec7 turn = Vec7::Zero();
  turn[4] = -angle;  // about the y axis
  turn[3] = 0.1 * std::sin(3.0 * angle);
  Sim3 T = sim3_exp(turn);
  T.t = Vec3(kRadius * std::cos(angle), 0.2 * std::sin(2.0 * angle), kRadius * std::sin(angle));
  return T;
}

}  // namespace

unisim_sim3 to_c(const Sim3& T) {
  return {{T.q.x(), T.q.y(), T.q.z(), T.q.w()}, {T.t[0], T.t[1], T.t[2]}, T.s};
}

Sim3 from_c(const unisim_sim3& T) {
  Sim3 to;
  to.q = Quat(T.q[3], T.q[0], T.q[1], T.q[2]);
  to.t = Vec3(T.t[0], T.t[1], T.t[2]);
  to.s = T.s;
  return to;
}

unisim_submap Views::submap() const {
  unisim_submap s = {};
  s.struct_size = sizeof s;
  s.count = static_cast<int32_t>(ids.size());
  s.keyframe_ids = ids.data();
  s.T_submap_kf = T_submap_kf.data();
  s.depth = maps.data();
  s.center_sigma = center_sigma;
  return s;
}

World::World(int32_t keyframes, uint32_t seed, const Noise& noise) : random_(seed), noise_(noise) {
  std::uniform_real_distribution<float> depths(1.0F, 4.0F);
  for (int32_t id = 0; id < keyframes; ++id) {
    truth_.push_back(on_circle(2.0 * kPi * id / keyframes));
    depth_.emplace_back(static_cast<size_t>(kDepthWidth * kDepthHeight));
    for (float& pixel : depth_.back()) pixel = depths(random_);
  }
}

double World::normal(double sigma) { return std::normal_distribution<double>()(random_) * sigma; }

Depth World::depth(int32_t id, double unit) {
  std::vector<float> pixels = depth_[static_cast<size_t>(id)];
  const auto factor = static_cast<float>(unit * std::exp(normal(noise_.depth)));
  for (float& pixel : pixels) pixel *= factor;
  return {pixels, kDepthWidth};
}

Sim3 World::pose(const Sim3& T, double unit) {
  constexpr double kMeanDepth = 2.5;
  Vec7 error = Vec7::Zero();
  for (int k = 0; k < 3; ++k) error[k] = normal(noise_.translation * kMeanDepth);
  for (int k = 3; k < 6; ++k) error[k] = normal(noise_.rotation);
  Sim3 predicted = T * sim3_exp(error);
  predicted.t *= unit;
  return predicted;
}

Pair World::pair(int32_t i, int32_t j) {
  const double unit = std::exp(normal(noise_.unit));
  Pair pair;
  pair.two_view = {};
  pair.two_view.struct_size = sizeof pair.two_view;
  pair.two_view.i = i;
  pair.two_view.j = j;
  pair.two_view.T_i_j = to_c(pose(between(truth(i), truth(j)), unit));
  pair.depth_i = depth(i, unit);
  pair.depth_j = depth(j, unit);
  return pair;
}

Views World::views(const std::vector<int32_t>& ids) {
  const double unit = std::exp(normal(noise_.unit));
  Views views;
  views.ids = ids;
  for (const int32_t id : ids) {
    views.T_submap_kf.push_back(to_c(pose(between(truth(ids.front()), truth(id)), unit)));
    views.depth.push_back(depth(id, unit));
  }
  for (const Depth& depth : views.depth) views.maps.push_back(depth.map());
  return views;
}

unisim_config default_config() {
  unisim_config config;
  REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
  return config;
}

Host::Host(const unisim_config& config) {
  size_t size = 0;
  REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
  arena_.reset(new unsigned char[size]);
  REQUIRE(unisim_session_create(&session_, &config, arena_.get(), size) == UNISIM_OK);
}

int32_t Host::add_keyframe() { return add_keyframe_at(1000 * keyframes_); }

int32_t Host::add_keyframe_at(int64_t timestamp_ns) {
  unisim_keyframe keyframe = {};
  keyframe.struct_size = sizeof keyframe;
  keyframe.timestamp_ns = timestamp_ns;
  int32_t id = -1;
  REQUIRE(unisim_add_keyframe(session_, &keyframe, &id) == UNISIM_OK);
  REQUIRE(id == keyframes_);
  ++keyframes_;
  return id;
}

unisim_status Host::add_pair(const Pair& pair) {
  unisim_two_view two_view = pair.two_view;
  two_view.depth_i = pair.depth_i.map();
  two_view.depth_j = pair.depth_j.map();
  return unisim_add_two_view(session_, &two_view);
}

unisim_status Host::reject_pair() {
  const unisim_request request = next(UNISIM_REQUEST_PAIR);
  REQUIRE(request.kind == UNISIM_REQUEST_PAIR);
  return unisim_reject_request(session_, &request);
}

int32_t Host::add_submap(const Views& views) {
  const unisim_submap submap = views.submap();
  int32_t id = -2;
  REQUIRE(unisim_add_submap(session_, &submap, &id) == UNISIM_OK);
  return id;
}

int32_t Host::add_loop(const Views& views) {
  const unisim_submap submap = views.submap();
  int32_t id = -2;
  REQUIRE(unisim_add_loop(session_, &submap, &id) == UNISIM_OK);
  return id;
}

unisim_report Host::optimize(int32_t iterations) {
  unisim_budget budget = {sizeof budget, iterations};
  unisim_report report = {};
  report.struct_size = sizeof report;
  REQUIRE(unisim_optimize(session_, &budget, &report) == UNISIM_OK);
  return report;
}

unisim_pose Host::pose(int32_t id) const {
  unisim_pose pose = {};
  pose.struct_size = sizeof pose;
  REQUIRE(unisim_get_pose(session_, id, &pose) == UNISIM_OK);
  return pose;
}

unisim_session_info Host::info() const {
  unisim_session_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_info(session_, &info) == UNISIM_OK);
  return info;
}

unisim_request Host::next(uint32_t kinds) const {
  unisim_request request = {};
  request.struct_size = sizeof request;
  if (unisim_next_request(session_, kinds, &request) != UNISIM_OK) request.kind = 0;
  return request;
}

void Host::feed(World& world, int32_t count) {
  for (int32_t k = 0; k < count; ++k) {
    const int32_t id = add_keyframe();
    if (id > 0) REQUIRE(add_pair(world.pair(id - 1)) == UNISIM_OK);
    const unisim_request request = next(UNISIM_REQUEST_WINDOW);
    if (request.kind == 0) continue;
    const std::vector<int32_t> ids(request.keyframe_ids, request.keyframe_ids + request.count);
    REQUIRE(add_submap(world.views(ids)) >= 0);
  }
}

unisim_config small_windows(int32_t window_submaps) {
  unisim_config config = default_config();
  config.window_size = 8;
  config.window_overlap = 2;
  config.window_submaps = window_submaps;
  return config;
}

std::vector<int32_t> ids(int32_t first, int32_t count) {
  std::vector<int32_t> out;
  for (int32_t k = 0; k < count; ++k) out.push_back(first + k);
  return out;
}

std::vector<int32_t> both(int32_t a, int32_t b, int32_t half) {
  std::vector<int32_t> out = ids(a, half);
  for (const int32_t id : ids(b, half)) out.push_back(id);
  return out;
}

void feed_pairs(Host& host, World& world, int32_t count) {
  for (int32_t k = 0; k < count; ++k) {
    const int32_t id = host.add_keyframe();
    if (id > 0) REQUIRE(host.add_pair(world.pair(id - 1)) == UNISIM_OK);
  }
}

void feed(Host& host, World& world, int32_t count) {
  for (int32_t k = 0; k < count; ++k) {
    const int32_t submaps = host.info().submaps;
    host.feed(world, 1);
    if (host.info().submaps > submaps) host.optimize();
  }
}

double worst_position_error(const Host& host, const World& world, int32_t keyframes) {
  const Sim3 first = from_c(host.pose(0).T_world_kf);
  double worst = 0.0;
  double unit = 1.0;
  const auto relative = [&](int32_t id) -> Vec3 {
    return between(first, from_c(host.pose(id).T_world_kf)).t;
  };
  const Vec3 last = between(world.truth(0), world.truth(keyframes / 2)).t;
  unit = relative(keyframes / 2).norm() / last.norm();
  for (int32_t id = 0; id < keyframes; ++id) {
    const Vec3 truth = between(world.truth(0), world.truth(id)).t;
    worst = std::max(worst, (relative(id) / unit - truth).norm());
  }
  return worst;
}

}  // namespace unisim::test
