// SPDX-License-Identifier: MIT
// A listener that tells a run of the pipeline over LCM.
#include "drivers/lcm/session_publisher.hpp"

#include <algorithm>
#include <thread>

#include "drivers/pipeline/metre_book.hpp"
#include "drivers/pipeline/similarity.hpp"
#include "drivers/pipeline/stages.hpp"
#include "drivers/pipeline/submap_points.hpp"

namespace unisim::lcm {
namespace {

constexpr std::chrono::seconds kStatusPeriod(1);
// Between the messages of the last trajectory: receivers with usual buffers hold four.
constexpr std::chrono::milliseconds kChunkPause(5);

/// The world in metres where they are known: p' = metres p.
unisim_sim3 in_metres(unisim_sim3 T, const pipeline::Metre& metre) {
  if (!(metre.per_unit > 0.0)) return T;
  for (double& t : T.t) t *= metre.per_unit;
  T.s *= metre.per_unit;
  return T;
}

}  // namespace

SessionPublisher::SessionPublisher(unisim_lcm_publisher* publisher,
                                   const SessionPublisherOptions& options)
    : publisher_(publisher), options_(options), history_(options.folder) {
  poses_.reserve(UNISIM_LCM_CHUNK_POSES);
}

pipeline::Metre SessionPublisher::metre_of(int32_t segment) const {
  const bool live = live_.struct_size == 0 || segment == live_.segment;
  return live ? metre_ : pipeline_->metre(segment);
}

void SessionPublisher::say_unit(const pipeline::Metre& metre) {
  unisim_lcm_publisher_set_unit(
      publisher_, metre.per_unit > 0.0 ? UNISIM_LCM_UNIT_METRIC : UNISIM_LCM_UNIT_RELATIVE,
      metre.sigma);
}

bool SessionPublisher::read_pose(int32_t keyframe, unisim_pose* pose) const {
  return history_.read(pipeline_->session(), keyframe, pose);
}

bool SessionPublisher::read_info(unisim_session_info* info) const {
  *info = {};
  info->struct_size = sizeof *info;
  return unisim_get_info(pipeline_->session(), info) == UNISIM_OK;
}

void SessionPublisher::on_keyframe(int32_t /*id*/, const unisim_frame& frame) {
  image_width_ = frame.image.width;
  image_height_ = frame.image.height;
}

void SessionPublisher::on_frame(const unisim_frame& frame) {
  if (options_.images && frame.image.data != nullptr) {
    unisim_lcm_publish_image(publisher_, frame.timestamp_ns, &frame.image);
  }
}

/// A segment begins in its own unit, one that is localised in has that of its map: there is no jump
/// from one to the other.
void SessionPublisher::on_live_pose(const pipeline::LivePose& pose) {
  newest_ns_ = pose.timestamp_ns;
  const bool first = live_.struct_size == 0;
  if (first || (pose.keyframe_id >= 0 && pose.segment != live_.segment)) metre_ = pose.metre;
  say_unit(metre_);
  if (pose.late) return;
  const unisim_sim3 T_world_cam = in_metres(pose.T_world_cam, metre_);
  unisim_lcm_publish_pose(publisher_, pose.timestamp_ns, &T_world_cam);
}

void SessionPublisher::on_keyframe_pose(const unisim_pose& keyframe) {
  live_ = keyframe;
  live_.T_world_kf = in_metres(keyframe.T_world_kf, metre_);
  unisim_lcm_publish_keyframe(publisher_, &live_, revision(), nullptr);
}

void SessionPublisher::on_window(int32_t submap_id, const unisim_window_prediction& window) {
  if (window.count <= 0) return;
  last_windowed_ = std::max(last_windowed_, window.keyframe_ids[window.count - 1]);
  if (options_.points_per_submap > 0) send_points(submap_id, window);
}

void SessionPublisher::send_points(int32_t submap_id, const unisim_window_prediction& window) {
  unisim_submap_info submap{};
  submap.struct_size = sizeof submap;
  unisim_pose anchor{};
  if (unisim_get_submap(pipeline_->session(), submap_id, &submap) != UNISIM_OK ||
      !read_pose(window.keyframe_ids[window.count / 2], &anchor)) {
    return;
  }
  pipeline::sample_points(window, image_width_, image_height_, options_.points_per_submap, &xyz_);
  if (xyz_.empty()) return;
  unisim_lcm_points points{};
  points.struct_size = sizeof points;
  points.submap_id = submap_id;
  points.timestamp_ns = anchor.timestamp_ns;
  points.map_revision = revision();
  points.segment = anchor.segment;
  points.T_world_points = anchor.T_world_kf;
  points.T_world_points.s = submap.T_world_submap.s;
  const pipeline::Metre metre = metre_of(anchor.segment);
  points.T_world_points = in_metres(points.T_world_points, metre);
  say_unit(metre);
  points.xyz = xyz_.data();
  points.count = static_cast<int32_t>(xyz_.size() / 3);
  points.keyframe_id = anchor.keyframe_id;
  unisim_lcm_publish_points(publisher_, &points);
}

void SessionPublisher::on_optimized(const unisim_report& report) {
  unisim_session_info info{};
  if (!read_info(&info)) return;
  const bool was_relative = !metre_known();
  const bool metre_only = report.map_revision <= revision_;
  const bool other_metre =
      live_.struct_size != 0 && pipeline::differs(pipeline_->metre(live_.segment), metre_);
  if (!metre_only || other_metre) send_correction(report, metre_only);
  send_optimized_keyframes();
  // All that was sent is in the older unit.
  if (was_relative && metre_known()) begin_trajectory(0);
  if (info.loops <= loops_) return;
  loops_ = info.loops;
  // What has left the window moves with the oldest that it kept.
  const bool all = report.first_changed <= info.first_keyframe;
  begin_trajectory(all ? 0 : report.first_changed);
}

/// The jump from where listeners have the newest keyframe to where it is now: small steps that the
/// session did not count are in it, and what became known of the metre.
void SessionPublisher::send_correction(const unisim_report& report, bool metre_only) {
  revision_ = report.map_revision;
  if (metre_only) ++unit_changes_;
  unisim_pose now{};
  if (live_.struct_size == 0 || !read_pose(live_.keyframe_id, &now)) return;
  metre_ = pipeline_->metre(now.segment);
  say_unit(metre_);
  const unisim_sim3 before = live_.T_world_kf;
  live_ = now;
  live_.T_world_kf = in_metres(now.T_world_kf, metre_);
  unisim_lcm_correction correction{};
  correction.struct_size = sizeof correction;
  correction.map_revision = revision();
  correction.timestamp_ns = newest_ns_;
  correction.keyframe_id = live_.keyframe_id;
  correction.segment = live_.segment;
  correction.first_changed = report.first_changed;
  correction.last_changed = report.last_changed;
  correction.T_new_old = pipeline::compose(live_.T_world_kf, pipeline::inverse(before));
  unisim_lcm_publish_correction(publisher_, &correction);
}

/// Each keyframe once when a submap has it: only then its covariance says something.
void SessionPublisher::send_optimized_keyframes() {
  for (; next_covered_ <= last_windowed_; ++next_covered_) {
    unisim_pose pose{};
    if (!read_pose(next_covered_, &pose) || pose.confidence == 0) continue;
    double covariance[49];
    const bool known =
        options_.covariance &&
        unisim_get_covariance(pipeline_->session(), next_covered_, covariance) == UNISIM_OK;
    const pipeline::Metre metre = metre_of(pose.segment);
    pose.T_world_kf = in_metres(pose.T_world_kf, metre);
    say_unit(metre);
    unisim_lcm_publish_keyframe(publisher_, &pose, revision(), known ? covariance : nullptr);
  }
}

void SessionPublisher::on_retired(const unisim_retired& retired, const unisim_pose* pose) {
  history_.take(retired, pose);
}

void SessionPublisher::begin_trajectory(int32_t first) {
  const int32_t end = live_.struct_size == 0 ? 0 : live_.keyframe_id + 1;
  if (trajectory_.next < trajectory_.end) first = std::min(first, trajectory_.next);
  trajectory_ = {};
  if (first >= end) return;
  trajectory_.next = std::max(first, 0);
  trajectory_.end = end;
  const int32_t count = end - trajectory_.next;
  trajectory_.chunks = (count + UNISIM_LCM_CHUNK_POSES - 1) / UNISIM_LCM_CHUNK_POSES;
}

/// One message has one unit: metres where they are known of all its poses.
/// @return with the largest standard deviation; 0: the poses stay in the map's units
pipeline::Metre SessionPublisher::poses_in_metres() {
  pipeline::Metre all;
  for (const unisim_pose& pose : poses_) {
    const pipeline::Metre metre = metre_of(pose.segment);
    if (!(metre.per_unit > 0.0)) return {};
    all = {metre.per_unit, std::max(all.sigma, metre.sigma)};
  }
  for (unisim_pose& pose : poses_)
    pose.T_world_kf = in_metres(pose.T_world_kf, metre_of(pose.segment));
  return all;
}

void SessionPublisher::send_trajectory_chunk() {
  if (trajectory_.next >= trajectory_.end) return;
  const int32_t end = std::min(trajectory_.next + UNISIM_LCM_CHUNK_POSES, trajectory_.end);
  poses_.clear();
  for (int32_t id = trajectory_.next; id < end; ++id) {
    unisim_pose pose{};
    if (read_pose(id, &pose) && pose.confidence > 0) poses_.push_back(pose);
  }
  say_unit(poses_in_metres());
  unisim_lcm_publish_trajectory(publisher_, newest_ns_, revision(), poses_.data(),
                                static_cast<int32_t>(poses_.size()), trajectory_.chunk,
                                trajectory_.chunks);
  trajectory_.next = end;
  ++trajectory_.chunk;
}

void SessionPublisher::on_progress(const pipeline::Progress& progress) {
  int32_t first = 0;
  if (unisim_lcm_next_request(publisher_, &first) != 0) begin_trajectory(first);
  send_trajectory_chunk();
  // Cameras that give each frame twice would have every frame told.
  const bool other_reason =
      progress.reason != told_reason_ && progress.reason != UNISIM_REASON_DUPLICATE;
  const bool changed = progress.state != told_state_ || other_reason ||
                       metre_known() != told_metric_ ||
                       (live_.struct_size != 0 && live_.segment != told_segment_);
  if (changed || Clock::now() >= next_status_) send_status(progress);
}

void SessionPublisher::send_status(const pipeline::Progress& progress) {
  unisim_session_info info{};
  if (!read_info(&info)) return;
  unisim_pose newest{};
  const bool posed = info.last_posed >= 0 && read_pose(info.last_posed, &newest);
  fill_stages();
  say_unit(metre_);
  unisim_lcm_status status{};
  status.struct_size = sizeof status;
  status.state = progress.state;
  status.reason = progress.reason;
  status.timestamp_ns = progress.newest_ns;
  status.confidence = posed ? newest.confidence : 0;
  status.keyframe_id = posed ? newest.keyframe_id : -1;
  status.segment = posed ? newest.segment : -1;
  status.map_revision = revision();
  status.frames = progress.frames;
  status.frames_bad = progress.frames_bad;
  status.frames_dropped = progress.frames_dropped;
  status.queue_depth = progress.frames_waiting;
  status.keyframes = info.keyframes;
  status.submaps = info.submaps;
  status.loops = info.loops;
  status.lost_events = info.lost_events;
  status.stage_count = static_cast<int32_t>(stages_.size());
  status.stages = stages_.data();
  unisim_lcm_publish_status(publisher_, &status);
  told_state_ = progress.state;
  told_reason_ = progress.reason;
  told_metric_ = metre_known();
  told_segment_ = live_.struct_size != 0 ? live_.segment : -1;
  next_status_ = Clock::now() + kStatusPeriod;
}

/// Stages that have run, with the names of summary.json.
void SessionPublisher::fill_stages() {
  stages_.clear();
  for (const pipeline::Stage& stage : pipeline::kStages) {
    const pipeline::LatencyHistogram& times = pipeline_->result().times.*stage.times;
    if (times.count() == 0) continue;
    stages_.push_back({stage.name, times.count(), times.percentile_ms(0.5),
                       times.percentile_ms(0.95), times.max_ms()});
  }
}

void SessionPublisher::finish() {
  if (pipeline_ == nullptr || pipeline_->session() == nullptr) return;
  const bool other =
      live_.struct_size != 0 && pipeline_->metre(live_.segment).per_unit != metre_.per_unit;
  if (other) {
    unisim_report nothing_moved{};
    nothing_moved.map_revision = revision_;
    nothing_moved.first_changed = nothing_moved.last_changed = -1;
    send_correction(nothing_moved, true);
  }
  begin_trajectory(0);
  while (trajectory_.next < trajectory_.end) {
    send_trajectory_chunk();
    std::this_thread::sleep_for(kChunkPause);
  }
  send_status(pipeline_->result().progress);
}

}  // namespace unisim::lcm
