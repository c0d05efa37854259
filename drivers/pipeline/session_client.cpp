// SPDX-License-Identifier: MIT
// The one place of the pipeline that calls a session.
#include "drivers/pipeline/session_client.hpp"

#include <new>

namespace unisim::pipeline {
namespace {

template <typename Struct>
Struct sized() {
  Struct made{};
  made.struct_size = sizeof made;
  return made;
}

unisim_submap submap_of(const unisim_window_prediction& window) {
  auto submap = sized<unisim_submap>();
  submap.count = window.count;
  submap.keyframe_ids = window.keyframe_ids;
  submap.T_submap_kf = window.T_window_kf;
  submap.depth = window.depth;
  submap.center_sigma = window.center_sigma;
  return submap;
}

/// Not for want of a good configuration: that has been accepted.
Preparation failed(unisim_status status) {
  return {Preparation::Answer::kFailed,
          std::string("session: cannot be made: ") + unisim_status_string(status)};
}

}  // namespace

SessionClient::~SessionClient() { unisim_session_destroy(session_); }

Preparation SessionClient::create(const unisim_config& config) {
  size_t size = 0;
  unisim_status status = unisim_arena_size(&config, &size);
  if (status == UNISIM_ERR_INVALID_ARGUMENT) {
    return {Preparation::Answer::kBadConfiguration,
            std::string("session configuration: ") + unisim_status_string(status)};
  }
  if (status != UNISIM_OK) return failed(status);
  arena_.reset(new (std::nothrow) char[size]);
  if (arena_ == nullptr) {
    return {Preparation::Answer::kNoMemory, "session: no memory for its " +
                                                std::to_string(size >> 20) +
                                                " MiB; lower session.max_keyframes"};
  }
  loop_gate_ = config.sigma_gate_loop;
  status = unisim_session_create(&session_, &config, arena_.get(), size);
  return status == UNISIM_OK ? Preparation() : failed(status);
}

template <typename Call>
unisim_status SessionClient::timed(LatencyHistogram StageTimes::* stage, Call call) const {
  const ScopedLatency timer(times_->*stage);
  const InsideLibrary inside(*watch_);
  return call();
}

unisim_status SessionClient::add_keyframe(int64_t timestamp_ns, int32_t* id) {
  auto keyframe = sized<unisim_keyframe>();
  keyframe.timestamp_ns = timestamp_ns;
  return timed(&StageTimes::graph, [&] { return unisim_add_keyframe(session_, &keyframe, id); });
}

unisim_status SessionClient::add_two_view(int32_t i, int32_t j,
                                          const unisim_pair_prediction& pair) {
  auto two_view = sized<unisim_two_view>();
  two_view.i = i;
  two_view.j = j;
  two_view.T_i_j = pair.T_i_j;
  two_view.depth_i = pair.depth_i;
  two_view.depth_j = pair.depth_j;
  two_view.center_sigma = pair.center_sigma;
  two_view.log_scale_sigma = pair.log_scale_sigma;
  return timed(&StageTimes::depth_ratio, [&] { return unisim_add_two_view(session_, &two_view); });
}

unisim_status SessionClient::add_submap(const unisim_window_prediction& window,
                                        int32_t* submap_id) {
  const unisim_submap submap = submap_of(window);
  return timed(&StageTimes::depth_ratio,
               [&] { return unisim_add_submap(session_, &submap, submap_id); });
}

unisim_status SessionClient::add_loop(const unisim_window_prediction& window, int32_t* submap_id) {
  const unisim_submap submap = submap_of(window);
  return timed(&StageTimes::depth_ratio,
               [&] { return unisim_add_loop(session_, &submap, submap_id); });
}

unisim_status SessionClient::remove_loop(int32_t submap_id) {
  return timed(&StageTimes::graph, [&] { return unisim_remove_loop(session_, submap_id); });
}

unisim_status SessionClient::add_distance(unisim_distance distance) {
  distance.struct_size = sizeof distance;
  return timed(&StageTimes::graph, [&] { return unisim_add_distance(session_, &distance); });
}

unisim_status SessionClient::add_submap_unit(unisim_submap_unit unit) {
  unit.struct_size = sizeof unit;
  return timed(&StageTimes::graph, [&] { return unisim_add_submap_unit(session_, &unit); });
}

unisim_status SessionClient::get_scale(int32_t segment, unisim_scale* scale) {
  *scale = sized<unisim_scale>();
  return timed(&StageTimes::read, [&] { return unisim_get_scale(session_, segment, scale); });
}

unisim_status SessionClient::update_submap(int32_t submap_id,
                                           const unisim_window_revision& revision) {
  auto update = sized<unisim_submap_update>();
  update.submap_id = submap_id;
  update.count = revision.count;
  update.T_submap_kf = revision.T_window_kf;
  update.log_depth_ratio = revision.log_depth_ratio;
  update.center_sigma = revision.center_sigma;
  update.scale_settled = revision.scale_settled;
  return timed(&StageTimes::graph, [&] { return unisim_update_submap(session_, &update); });
}

unisim_status SessionClient::reject(const unisim_request& request) {
  return timed(&StageTimes::graph, [&] { return unisim_reject_request(session_, &request); });
}

unisim_status SessionClient::close_window() {
  return timed(&StageTimes::graph, [&] { return unisim_close_window(session_); });
}

unisim_status SessionClient::optimize(unisim_report* report) {
  *report = sized<unisim_report>();
  return timed(&StageTimes::optimize, [&] { return unisim_optimize(session_, nullptr, report); });
}

unisim_status SessionClient::next_request(uint32_t kinds, unisim_request* request) const {
  *request = sized<unisim_request>();
  return timed(&StageTimes::read, [&] { return unisim_next_request(session_, kinds, request); });
}

unisim_status SessionClient::get_pose(int32_t keyframe_id, unisim_pose* pose) const {
  *pose = sized<unisim_pose>();
  return timed(&StageTimes::read, [&] { return unisim_get_pose(session_, keyframe_id, pose); });
}

unisim_status SessionClient::next_retired(unisim_retired* retired) {
  *retired = sized<unisim_retired>();
  return timed(&StageTimes::read, [&] { return unisim_next_retired(session_, retired); });
}

unisim_status SessionClient::get_info(unisim_session_info* info) const {
  *info = sized<unisim_session_info>();
  return timed(&StageTimes::read, [&] { return unisim_get_info(session_, info); });
}

}  // namespace unisim::pipeline
