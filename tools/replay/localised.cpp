// SPDX-License-Identifier: MIT
// Results of a run that only looks for frames in a map.
#include "tools/replay/localised.hpp"

#include <algorithm>

#include "drivers/common/format.hpp"
#include "drivers/common/stamp_text.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/json_text.hpp"
#include "tools/common/output.hpp"
#include "tools/replay/pose_files.hpp"
#include "tools/replay/progress_line.hpp"
#include "tools/replay/summary.hpp"
#include "tools/replay/version.hpp"

namespace unisim::replay {

int LocalisedFrames::write(const pipeline::Result& result, const eval::Trajectory& truth,
                           const std::string& format) {
  RunData data;
  std::vector<pipeline::Metre> metres;
  for (int64_t k = 0; k < frames_.size(); ++k) {
    const pipeline::LocatedFrame frame = frames_.get(k);
    ++counts_.frames;
    if (frame.state == UNISIM_STATE_LOST) continue;
    ++(frame.state == UNISIM_STATE_TRACKING ? counts_.followed : counts_.anew);
    data.trajectory.push_back({frame.timestamp_ns, frame.T_world_cam});
    metres.push_back(frame.metre);
  }
  if (take_metres(metres)) {
    for (size_t k = 0; k < metres.size(); ++k) {
      for (double& t : data.trajectory[k].T_world_cam.t) t *= metres[k].per_unit;
    }
  }
  data.live = data.trajectory;
  const Scores scores = data.trajectory.empty() ? Scores() : score(truth, data);
  write_files(result, scores, data.trajectory, format);
  if (!scores.problem.empty()) tools::complain(options_.program, scores.problem);
  for (const std::string& line : folder_.failures()) tools::complain(options_.program, line);
  if (!folder_.failures().empty()) return tools::kExitLimit;
  if (counts_.found() > 0 || result.outcome != pipeline::Outcome::kFinished)
    return tools::kExitDone;
  tools::complain(options_.program, options_.load_map + ": none of " +
                                        std::to_string(counts_.frames) +
                                        " frames is found in this map");
  return tools::kExitInput;
}

/// In metres where all of the poses can be. @return whether they can
bool LocalisedFrames::take_metres(const std::vector<pipeline::Metre>& metres) {
  const bool known = !metres.empty() &&
                     std::all_of(metres.begin(), metres.end(),
                                 [](const pipeline::Metre& metre) { return metre.per_unit > 0.0; });
  if (known) metre_ = SegmentScale{-1, metres.back().per_unit, metres.back().sigma};
  return known;
}

void LocalisedFrames::write_files(const pipeline::Result& result, const Scores& scores,
                                  const std::vector<unisim_stamped_pose>& poses,
                                  const std::string& format) {
  const double scale = scores.ate ? scores.ate->T_truth_estimate.s : 0.0;
  folder_.write_text("trajectory.tum",
                     trajectory_text("frames found in " + options_.load_map +
                                         ", in the frame and unit of its trajectory",
                                     poses, scale, metre_ ? &*metre_ : nullptr));
  folder_.write_text("localised.csv", table());
  const auto ms = [&](double share) { return result.times.track_total.percentile_ms(share); };
  const tools::Json summary = {
      {"schema", 1},
      {"version", version_text()},
      {"sequence", options_.sequence},
      {"format", format},
      {"protocol",
       {{"map", options_.load_map},
        {"from", options_.from},
        {"to", options_.to < 0 ? tools::Json(nullptr) : tools::Json(options_.to)},
        {"stride", options_.settings.pipeline.keyframes.stride},
        {"alignment", "sim3"}}},
      {"frames", counts_.frames},
      {"located", counts_.found()},
      {"followed", counts_.followed},
      {"looked_for_anew", counts_.anew},
      {"unit", metre_ ? "metric" : "relative"},
      {"metres_per_unit", metre_ ? tools::Json(metre_->metres_per_unit) : tools::Json(nullptr)},
      {"scale_sigma", metre_ ? tools::Json(metre_->sigma) : tools::Json(nullptr)},
      {"ate_rmse_m", scores.ate ? tools::Json(scores.ate->error.rmse) : tools::Json(nullptr)},
      {"timing_ms",
       {{"locate",
         {{"p50", ms(0.5)}, {"p95", ms(0.95)}, {"max", result.times.track_total.max_ms()}}}}},
      {"memory",
       {{"process_peak_bytes", process_peak_bytes()},
        {"predictor_bytes", result.predictor.state_bytes}}},
      {"wall_s", result.wall_s}};
  folder_.write_text("summary.json", tools::json_text(summary, 1) + "\n");
  if (options_.json) {
    tools::print(
        tools::json_text({{"type", "result"}, {"files", folder_.written()}, {"summary", summary}}) +
        "\n");
  } else {
    tools::print(text(result, scores));
  }
}

std::string LocalisedFrames::table() const {
  std::string out = "frame,timestamp,state,confidence,inliers,keyframe\n";
  for (int64_t k = 0; k < frames_.size(); ++k) {
    const pipeline::LocatedFrame frame = frames_.get(k);
    out += std::to_string(frame.frame_index) + "," + drivers::stamp_text(frame.timestamp_ns) +
           drivers::format(",%s,%.3f,%d,%d\n", state_name(frame.state), frame.confidence,
                           frame.inliers, frame.keyframe_id);
  }
  return out;
}

std::string LocalisedFrames::text(const pipeline::Result& result, const Scores& scores) const {
  std::string out = drivers::format(
      "%s: %lld of %lld frames found in %s, %lld where the frame before let expect "
      "them, %lld anew\n%.1f ms a frame (p95 %.1f, max %.1f)\n",
      options_.sequence.c_str(), static_cast<long long>(counts_.found()),
      static_cast<long long>(counts_.frames), options_.load_map.c_str(),
      static_cast<long long>(counts_.followed), static_cast<long long>(counts_.anew),
      result.times.track_total.percentile_ms(0.5), result.times.track_total.percentile_ms(0.95),
      result.times.track_total.max_ms());
  if (scores.ate) {
    out += drivers::format("ATE %.4f m RMSE (Sim(3), %zu frames)\n", scores.ate->error.rmse,
                           scores.ate->pairs.size());
  }
  if (metre_) {
    out += drivers::format("metric: 1 unit of the map = %.4g m +- %.2g %%\n",
                           metre_->metres_per_unit, 100.0 * metre_->sigma);
  }
  for (const std::string& file : folder_.written()) out += "wrote " + file + "\n";
  return out;
}

}  // namespace unisim::replay
