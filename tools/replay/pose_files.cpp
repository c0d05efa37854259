// SPDX-License-Identifier: MIT
// Trajectories and the keyframe table as text.
#include "tools/replay/pose_files.hpp"

#include "drivers/common/format.hpp"
#include "drivers/common/stamp_text.hpp"
#include "drivers/pipeline/tracking_reason.hpp"
#include "tools/replay/progress_line.hpp"

namespace unisim::replay {
namespace {

using drivers::format;

const char* asked_for(int32_t asked) {
  switch (asked) {
    case UNISIM_PLACE_LOST:
      return "lost";
    case UNISIM_PLACE_JOIN:
      return "join";
    default:
      return "loop";
  }
}

}  // namespace

std::string trajectory_header(const std::string& title, double scale, const SegmentScale* known) {
  std::string text = "# " + title + "\n";
  text += "# timestamp [s] tx ty tz qx qy qz qw; camera-to-world, OpenCV axes\n";
  if (known == nullptr) {
    text += "# unit of length: arbitrary, one camera does not see scale\n";
  } else {
    text += format("# unit of length: metre, known to %.2g %% (1 standard deviation)\n",
                   100.0 * known->sigma);
    text +=
        format("# 1 unit of the map and of trajectory_live.tum = %.9g m\n", known->metres_per_unit);
  }
  if (scale > 0.0) text += format("# aligned with ground truth, 1 unit = %.9g m\n", scale);
  return text;
}

std::string trajectory_line(const unisim_stamped_pose& pose) {
  const unisim_sim3& T = pose.T_world_cam;
  std::string text = drivers::stamp_text(pose.timestamp_ns);
  text += format(" %.10g %.10g %.10g %.10g %.10g %.10g %.10g\n", T.t[0], T.t[1], T.t[2], T.q[0],
                 T.q[1], T.q[2], T.q[3]);
  return text;
}

std::string trajectory_text(const std::string& title, const std::vector<unisim_stamped_pose>& poses,
                            double scale, const SegmentScale* known) {
  std::string text = trajectory_header(title, scale, known);
  for (const unisim_stamped_pose& pose : poses) text += trajectory_line(pose);
  return text;
}

std::string keyframe_table(const RunData& data) {
  std::string text =
      "id,timestamp,scale,state,confidence,submap,covariance_trace,segment,frame,unit,reason,"
      "position_sigma,rotation_sigma\n";
  for (const KeyframeRow& row : data.keyframes) {
    text += format("%d,", row.pose.keyframe_id);
    text += drivers::stamp_text(row.pose.timestamp_ns);
    text += format(",%.10g,%s,%d,%d,", row.pose.T_world_kf.s, state_name(row.pose.state),
                   row.pose.confidence, row.pose.submap_id);
    if (row.covariance_trace >= 0.0) text += format("%.6g", row.covariance_trace);
    text += format(",%d,%lld,%s,%s,", row.pose.segment, static_cast<long long>(row.frame_index),
                   data.metric ? "metric" : "relative", pipeline::reason_name(row.reason));
    if (row.sigma.position >= 0.0) text += format("%.6g", row.sigma.position);
    text += ",";
    if (row.sigma.rotation >= 0.0) text += format("%.6g", row.sigma.rotation);
    text += "\n";
  }
  return text;
}

std::string place_table(const pipeline::RecordFile<unisim_place_report>& told,
                        const unisim_predictor_info& info) {
  std::string text =
      "keyframe,candidate,asked,score,matches,pose_inliers,patch_inliers,in_view,accepted,reason\n";
  const int64_t all = info.places_past + info.place_count;
  for (int64_t k = 0; k < all; ++k) {
    const unisim_place_report report =
        k < told.size() ? told.get(k) : info.places[k - info.places_past];
    text += format("%d,%d,%s,%d,%d,%d,%d,%d,%d,%s\n", report.keyframe, report.candidate,
                   asked_for(report.asked), report.score, report.matches, report.pose_inliers,
                   report.patch_inliers, report.in_view, report.accepted, report.reason);
  }
  return text;
}

}  // namespace unisim::replay
