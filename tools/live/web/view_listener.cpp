// SPDX-License-Identifier: MIT
// Looks on while a run goes, and hands what the page shows to the feed.
#include "tools/live/web/view_listener.hpp"

#include <algorithm>

#include "drivers/common/packed_copy.hpp"
#include "drivers/pipeline/stages.hpp"
#include "drivers/pipeline/submap_points.hpp"

namespace unisim::live::web {
namespace {

constexpr std::chrono::milliseconds kViewPeriod(100);
constexpr std::chrono::seconds kMapPeriod(1);
// Brought up to date with each frame: all of them within two seconds of a camera, in a tenth of a
// millisecond.
constexpr size_t kRefreshed = 24;
constexpr size_t kLineBytes = 400;

}  // namespace

ViewListener::ViewListener(Feed* feed, const PoseAge* ages, const std::string& folder)
    : feed_(feed), ages_(ages), history_(folder) {}

void ViewListener::attach(const pipeline::Pipeline* pipeline, unisim_predictor* predictor) {
  pipeline_ = pipeline;
  predictor_ = predictor;
}

bool ViewListener::read(int32_t keyframe, unisim_pose* pose) const {
  return history_.read(pipeline_->session(), keyframe, pose);
}

void ViewListener::on_live_pose(const pipeline::LivePose& pose) {
  newest_.keyframe = pose.keyframe_id;
  newest_.T_world_cam = pose.T_world_cam;
  newest_.segment = pose.segment;
  posed_ns_ = pose.timestamp_ns;
  live_.add(newest_);
}

void ViewListener::on_keyframe_pose(const unisim_pose& keyframe) {
  confidence_ = keyframe.confidence;
  PathPoint point;
  point.keyframe = keyframe.keyframe_id;
  point.segment = keyframe.segment;
  point.T_world_cam = keyframe.T_world_kf;
  corrected_.add(point);
}

void ViewListener::on_window(int32_t submap_id, const unisim_window_prediction& window) {
  if (window.count <= 0) return;
  if (!cloud_.takes_next()) return cloud_.skip();
  CloudPatch patch;
  patch.submap = submap_id;
  patch.keyframe = window.keyframe_ids[window.count / 2];
  pipeline::sample_points(window, image_width_, image_height_, kPatchPoints, &xyz_);
  patch.count = xyz_.size() / 3;
  std::copy(xyz_.begin(), xyz_.end(), patch.xyz.begin());
  refresh_patch(&patch);
  cloud_.add(patch);
}

/// Where the submap is today; one that cannot be asked any more keeps its scale.
void ViewListener::refresh_patch(CloudPatch* patch) {
  unisim_pose anchor{};
  if (!read(patch->keyframe, &anchor)) return;
  const double scale = patch->T_world_points.s;
  patch->T_world_points = anchor.T_world_kf;
  patch->T_world_points.s = scale;
  patch->segment = anchor.segment;
  unisim_submap_info submap{};
  submap.struct_size = sizeof submap;
  if (unisim_get_submap(pipeline_->session(), patch->submap, &submap) == UNISIM_OK) {
    patch->T_world_points.s = submap.T_world_submap.s;
  }
}

void ViewListener::on_retired(const unisim_retired& retired, const unisim_pose* pose) {
  history_.take(retired, pose);
}

void ViewListener::on_message(const std::string& line) {
  messages_.push_back(line.substr(0, kLineBytes));
  if (messages_.size() > kMessages) messages_.pop_front();
}

void ViewListener::on_frame(const unisim_frame& frame) {
  image_width_ = frame.image.width;
  image_height_ = frame.image.height;
  if (!feed_->watched()) return;
  refresh();
  if (Clock::now() >= next_view_) take_image(frame);
}

void ViewListener::take_image(const unisim_frame& frame) {
  view_.has_image = frame.image.data != nullptr;
  if (!view_.has_image) return;
  view_.image = drivers::packed_copy(frame.image, &view_.pixels);
  view_.features.clear();
  if (predictor_->features != nullptr) {
    const unisim_feature* features = nullptr;
    const int32_t count = predictor_->features(predictor_, &features);
    if (count > 0) view_.features.assign(features, features + count);
  }
  view_.posed = posed_ns_ == frame.timestamp_ns;
  view_.T_world_cam = newest_.T_world_cam;
}

/// A few in turn.
void ViewListener::refresh() {
  std::vector<PathPoint>& path = corrected_.items();
  for (size_t k = 0; k < std::min(kRefreshed, path.size()); ++k) {
    next_point_ = (next_point_ + 1) % path.size();
    PathPoint& point = path[next_point_];
    unisim_pose pose{};
    if (!read(point.keyframe, &pose)) continue;
    point.T_world_cam = pose.T_world_kf;
    point.segment = pose.segment;
  }
  std::vector<CloudPatch>& cloud = cloud_.items();
  if (cloud.empty()) return;
  next_patch_ = (next_patch_ + 1) % cloud.size();
  refresh_patch(&cloud[next_patch_]);
}

void ViewListener::on_progress(const pipeline::Progress& progress) {
  const Clock::time_point now = Clock::now();
  const double rate = rate_.update(progress.frames);
  if (now < next_view_) return;
  next_view_ = now + kViewPeriod;
  view_.frames_per_second = rate;
  take_status(progress);
  view_.has_map = feed_->watched() && now >= next_map_;
  if (view_.has_map) {
    next_map_ = now + kMapPeriod;
    take_map();
  }
  feed_->offer(&view_);
  view_.has_image = false;
}

void ViewListener::take_status(const pipeline::Progress& progress) {
  view_.progress = progress;
  view_.session = {};
  view_.session.struct_size = sizeof view_.session;
  if (unisim_get_info(pipeline_->session(), &view_.session) != UNISIM_OK) view_.session = {};
  view_.confidence = confidence_;
  view_.segment = posed_ns_ >= 0 ? newest_.segment : -1;
  view_.age_p50_ms = ages_->ages().percentile_ms(0.5);
  view_.age_p95_ms = ages_->ages().percentile_ms(0.95);
  view_.age_p99_ms = ages_->ages().percentile_ms(0.99);
  view_.stages.clear();
  for (const pipeline::Stage& stage : pipeline::kStages) {
    const pipeline::LatencyHistogram& times = pipeline_->result().times.*stage.times;
    if (times.count() == 0) continue;
    view_.stages.push_back({stage.name, times.count(), times.percentile_ms(0.5),
                            times.percentile_ms(0.95), times.max_ms()});
  }
  view_.messages.assign(messages_.begin(), messages_.end());
}

void ViewListener::take_map() {
  view_.live.assign(live_.items().begin(), live_.items().end());
  view_.corrected.assign(corrected_.items().begin(), corrected_.items().end());
  view_.cloud.assign(cloud_.items().begin(), cloud_.items().end());
  if (posed_ns_ >= 0) view_.live.push_back(newest_);
}

}  // namespace unisim::live::web
