// SPDX-License-Identifier: MIT
// A session with its arena that takes simulated predictions.
#include "tools/bench/walk/walk_session.hpp"

#include <string>

#include "tools/bench/simulator/c_structs.hpp"
#include "tools/common/failure.hpp"

namespace unisim::bench {

using simulator::to_c;

namespace {

constexpr int64_t kKeyframePeriodNs = 166666667;

// Small enough for the full weight: all simulated predictions are equally good.
constexpr double kCenterSigma = 0.0005;

size_t depth_bytes_of(const unisim_config& config) {
  constexpr size_t kMostParts = 32;
  unisim_arena_part parts[kMostParts];
  size_t count = 0;
  if (unisim_arena_parts(&config, parts, kMostParts, &count) != UNISIM_OK) return 0;
  for (size_t k = 0; k < count; ++k) {
    if (std::string(parts[k].name) == "depth") return parts[k].bytes;
  }
  return 0;
}

}  // namespace

WalkSession::WalkSession(const unisim_config& config, const pipeline::HeapWatch& heap)
    : config_(config), heap_(heap) {
  size_t bytes = 0;
  expect_ok(unisim_arena_size(&config, &bytes), "unisim_arena_size");
  arena_.resize(bytes);
  depth_bytes_ = depth_bytes_of(config);
  expect_ok(unisim_session_create(&session_, &config, arena_.data(), arena_.size()),
            "unisim_session_create");
  poses_.reserve(UNISIM_MAX_VIEWS);
  maps_.reserve(UNISIM_MAX_VIEWS);
}

WalkSession::~WalkSession() { unisim_session_destroy(session_); }

void WalkSession::expect_ok(unisim_status status, const char* call) const {
  if (status == UNISIM_OK) return;
  throw tools::Failure(tools::kExitLimit, std::string(call) + ": " + unisim_status_string(status) +
                                              " at keyframe " + std::to_string(keyframes_ - 1));
}

void WalkSession::add_keyframe() {
  const unisim_keyframe keyframe{sizeof(unisim_keyframe), 0, kKeyframePeriodNs * keyframes_};
  int32_t id = -1;
  const pipeline::InsideLibrary inside(heap_);
  expect_ok(unisim_add_keyframe(session_, &keyframe, &id), "unisim_add_keyframe");
  ++keyframes_;
}

void WalkSession::add_pair(const simulator::Prediction& pair) {
  unisim_two_view two_view{};
  two_view.struct_size = sizeof two_view;
  two_view.i = pair.keyframes[0];
  two_view.j = pair.keyframes[1];
  two_view.T_i_j = to_c(pair.T_local_kf[1]);
  two_view.depth_i = to_c(pair.depth[0]);
  two_view.depth_j = to_c(pair.depth[1]);
  two_view.center_sigma = kCenterSigma;
  const pipeline::InsideLibrary inside(heap_);
  expect_ok(unisim_add_two_view(session_, &two_view), "unisim_add_two_view");
}

bool WalkSession::next_window(int32_t* first, int32_t* count) {
  unisim_request request{};
  request.struct_size = sizeof request;
  const pipeline::InsideLibrary inside(heap_);
  if (unisim_next_request(session_, UNISIM_REQUEST_WINDOW, &request) != UNISIM_OK) return false;
  *first = request.keyframe_ids[0];
  *count = request.count;
  return true;
}

bool WalkSession::close_window() { return unisim_close_window(session_) == UNISIM_OK; }

unisim_submap WalkSession::describe(const simulator::Prediction& prediction) {
  poses_.clear();
  maps_.clear();
  for (const simulator::RigidPose& T : prediction.T_local_kf) poses_.push_back(to_c(T));
  for (const simulator::DepthMap& depth : prediction.depth) maps_.push_back(to_c(depth));
  unisim_submap submap{};
  submap.struct_size = sizeof submap;
  submap.count = static_cast<int32_t>(prediction.keyframes.size());
  submap.keyframe_ids = prediction.keyframes.data();
  submap.T_submap_kf = poses_.data();
  submap.depth = maps_.data();
  submap.center_sigma = kCenterSigma;
  return submap;
}

void WalkSession::add_window(const simulator::Prediction& window) {
  const unisim_submap submap = describe(window);
  int32_t id = -1;
  const pipeline::InsideLibrary inside(heap_);
  expect_ok(unisim_add_submap(session_, &submap, &id), "unisim_add_submap");
}

bool WalkSession::add_loop(const simulator::Prediction& loop) {
  const unisim_submap submap = describe(loop);
  int32_t id = -1;
  const pipeline::InsideLibrary inside(heap_);
  const unisim_status status = unisim_add_loop(session_, &submap, &id);
  if (status == UNISIM_ERR_RETIRED) return false;
  expect_ok(status, "unisim_add_loop");
  return true;
}

void WalkSession::optimize(int32_t iterations) {
  const unisim_budget budget{sizeof(unisim_budget), iterations};
  const pipeline::InsideLibrary inside(heap_);
  expect_ok(unisim_optimize(session_, &budget, nullptr), "unisim_optimize");
}

void WalkSession::read_retired() {
  unisim_retired retired{};
  retired.struct_size = sizeof retired;
  while (unisim_next_retired(session_, &retired) == UNISIM_OK) book_.take(retired);
}

Eigen::Vector3d WalkSession::position(int32_t keyframe) const {
  unisim_pose pose{};
  pose.struct_size = sizeof pose;
  unisim_status status = unisim_get_pose(session_, keyframe, &pose);
  if (status == UNISIM_ERR_RETIRED && book_.find(session_, keyframe, &pose.T_world_kf)) {
    status = UNISIM_OK;
  }
  expect_ok(status, "unisim_get_pose");
  return Eigen::Map<const Eigen::Vector3d>(pose.T_world_kf.t);
}

unisim_session_info WalkSession::info() const {
  unisim_session_info info{};
  info.struct_size = sizeof info;
  expect_ok(unisim_get_info(session_, &info), "unisim_get_info");
  return info;
}

}  // namespace unisim::bench
