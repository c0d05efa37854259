// SPDX-License-Identifier: MIT
// The figures of a run.
#include "tools/replay/summary.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "drivers/common/format.hpp"
#include "drivers/onnx/onnx.h"
#include "drivers/pipeline/stages.hpp"
#include "drivers/pipeline/tracking_reason.hpp"
#include "tools/replay/version.hpp"

namespace unisim::replay {
namespace {

using drivers::format;
using tools::Json;

Json map_json(const std::string& path) { return path.empty() ? Json(nullptr) : Json(path); }

Json rmse_of(const std::optional<eval::Ate>& ate) {
  return ate ? Json(ate->error.rmse) : Json(nullptr);
}

Json stage_json(const pipeline::LatencyHistogram& times) {
  return {{"n", times.count()},
          {"p50", times.percentile_ms(0.5)},
          {"p95", times.percentile_ms(0.95)},
          {"max", times.max_ms()}};
}

Json protocol_json(const Run& run) {
  const Options& o = run.options;
  const int32_t stride = o.settings.pipeline.keyframes.stride;
  const bool given = o.settings.geometric.focal_px > 0.0;
  return {{"stride", stride > 0 ? Json(stride) : Json("motion")},
          {"from", o.from},
          {"to", o.to < 0 ? Json(nullptr) : Json(o.to)},
          {"predictor", o.predictor},
          {"intrinsics", given ? "given" : "estimated"},
          {"ground_truth", run.truth.name},
          {"alignment", "sim3"},
          {"associated", run.scores.ate ? run.scores.ate->pairs.size() : 0},
          {"poses", run.scores.poses},
          {"poses_live", run.scores.live_poses},
          {"window", o.settings.session.window_size},
          {"overlap", o.settings.session.window_overlap},
          {"realtime", o.settings.pipeline.realtime}};
}

Json segments_json(const Scores& scores) {
  Json list = Json::array();
  for (const SegmentScore& segment : scores.segments) {
    list.push_back(
        {{"first", segment.first},
         {"last", segment.last},
         {"keyframes", segment.keyframes},
         {"ate_rmse_m", segment.ate_rmse_m ? Json(*segment.ate_rmse_m) : Json(nullptr)}});
  }
  return list;
}

/// Of each segment whose scale is known.
Json scales_json(const RunData& data) {
  Json list = Json::array();
  for (const SegmentScale& scale : data.scales) {
    list.push_back({{"segment", scale.segment},
                    {"metres_per_unit", scale.metres_per_unit},
                    {"sigma", scale.sigma}});
  }
  return list;
}

Json distances_json(const RunData& data) {
  return {{"taken", data.distances.taken},
          {"refused", data.distances.refused},
          {"waiting", data.distances.waiting},
          {"lost", data.distances.lost}};
}

/// What the predictor says of its loops: those it counts, and those it looked at and left.
Json loops_json(const Run& run) {
  const unisim_predictor_info& info = run.result.predictor;
  return {{"candidates", info.loops_tried},
          {"accepted", info.loops_accepted},
          {"rejected", info.loops_tried - info.loops_accepted},
          {"undone", info.loops_undone}};
}

Json lanes_json(const pipeline::LaneReport& lanes) {
  return {{"windows_beside", lanes.beside},   {"lag_keyframes", lanes.lag},
          {"windows_asked", lanes.asked},     {"windows_late", lanes.late},
          {"windows_dropped", lanes.dropped}, {"most_waiting", lanes.most_waiting},
          {"waited_ms", lanes.waited_ms}};
}

Json memory_json(const Run& run) {
  Json memory = {{"arena_bytes", run.data.session.arena_bytes},
                 {"arena_peak_bytes", run.data.session.arena_peak_bytes},
                 {"process_peak_bytes", process_peak_bytes()},
                 {"predictor_bytes", run.result.predictor.state_bytes}};
  if (run.result.heap_calls >= 0) memory["heap_calls_after_init"] = run.result.heap_calls;
  return memory;
}

Json timing_json(const pipeline::StageTimes& times) {
  Json json;
  for (const pipeline::Stage& stage : pipeline::kStages) {
    json[stage.name] = stage_json(times.*stage.times);
  }
  return json;
}

const char* outcome_name(pipeline::Outcome outcome) {
  switch (outcome) {
    case pipeline::Outcome::kFinished:
      return "finished";
    case pipeline::Outcome::kStopped:
      return "interrupted";
    case pipeline::Outcome::kCapacity:
      return "map full";
    case pipeline::Outcome::kSourceFailed:
      return "source failed";
    case pipeline::Outcome::kPredictorFailed:
      return "predictor failed";
    case pipeline::Outcome::kSessionFailed:
      return "session failed";
  }
  return "unknown";
}

/// Frames with each reason there was.
Json reasons_json(const pipeline::Result& result) {
  Json reasons = Json::object();
  for (int32_t reason = 1; reason < UNISIM_REASON_COUNT; ++reason) {
    const int64_t frames = result.frames_by_reason[static_cast<size_t>(reason)];
    if (frames > 0) reasons[pipeline::reason_name(reason)] = frames;
  }
  return reasons;
}

double frames_per_second(const pipeline::Result& result) {
  return static_cast<double>(result.progress.frames) / std::max(result.wall_s, 1e-9);
}

std::string score_line(const Run& run) {
  const Scores& scores = run.scores;
  if (!scores.ate) return scores.problem.empty() ? "no ground truth, no score\n" : "no score\n";
  std::string line = format("ATE %.4f m RMSE (Sim(3), %zu %s)", scores.ate->error.rmse,
                            scores.ate->pairs.size(), scores.poses.c_str());
  if (scores.live) line += format(", live poses %.4f m", scores.live->error.rmse);
  if (scores.rpe) line += format(", RPE %.4f m", scores.rpe->translation.rmse);
  line += format(run.data.metric ? ", 1 m of the map = %.4g m\n" : ", 1 unit = %.4g m\n",
                 scores.ate->T_truth_estimate.s);
  if (scores.segments.size() < 2) return line;
  const SegmentScore& longest = *std::max_element(
      scores.segments.begin(), scores.segments.end(),
      [](const SegmentScore& a, const SegmentScore& b) { return a.keyframes < b.keyframes; });
  line += format("longest segment: %d keyframes", longest.keyframes);
  if (longest.ate_rmse_m) line += format(", aligned by itself ATE %.4f m", *longest.ate_rmse_m);
  return line + "\n";
}

/// From the middle of the image to the right and down.
Json principal_json(const unisim_predictor_info& predictor) {
  return Json::array({predictor.center_x_px, predictor.center_y_px});
}

}  // namespace

std::string keyframe_choice(const Options& options) {
  const int32_t stride = options.settings.pipeline.keyframes.stride;
  return stride > 0 ? "every " + std::to_string(stride) : "by motion";
}

int64_t process_peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::max(int64_t{usage.ru_maxrss} * 1024, unisim_onnx_peak_before_bytes());
}

double coverage(const RunData& data) {
  if (data.session.keyframes == 0) return 0.0;
  return static_cast<double>(data.session.posed_keyframes) /
         static_cast<double>(data.session.keyframes);
}

Json summary_json(const Run& run) {
  const unisim_session_info& info = run.data.session;
  const Scores& scores = run.scores;
  const pipeline::Progress& progress = run.result.progress;
  const double focal = run.result.predictor.focal_px;
  const SegmentScale* known = run.data.main_scale();
  return {
      {"schema", 1},
      {"version", version_text()},
      {"sequence", run.options.sequence},
      {"format", run.format},
      {"protocol", protocol_json(run)},
      {"outcome", outcome_name(run.result.outcome)},
      {"frames", progress.frames},
      {"frames_bad", progress.frames_bad},
      {"frames_dropped", progress.frames_dropped},
      {"keyframes", info.keyframes},
      {"submaps", info.submaps},
      {"loops", loops_json(run)},
      {"ate_rmse_m", rmse_of(scores.ate)},
      {"ate_live_rmse_m", rmse_of(scores.live)},
      {"rpe_trans_rmse_m", scores.rpe ? Json(scores.rpe->translation.rmse) : Json(nullptr)},
      {"unit", run.data.metric ? "metric" : "relative"},
      {"metres_per_unit", known != nullptr ? Json(known->metres_per_unit) : Json(nullptr)},
      {"scale_sigma", known != nullptr ? Json(known->sigma) : Json(nullptr)},
      {"segment_scales", scales_json(run.data)},
      {"distances", distances_json(run.data)},
      {"scale", scores.ate ? Json(scores.ate->T_truth_estimate.s) : Json(nullptr)},
      {"score_problem", run.scores.problem.empty() ? Json(nullptr) : Json(run.scores.problem)},
      {"coverage", coverage(run.data)},
      {"keyframes_unposed", info.keyframes - info.posed_keyframes},
      {"lost_events", info.lost_events},
      {"frame_reasons", reasons_json(run.result)},
      {"relocalised", run.result.predictor.relocalised},
      {"segments_joined", run.result.predictor.joined},
      {"segment_scores", segments_json(run.scores)},
      {"segments", info.segments},
      {"map_loaded", map_json(run.options.load_map)},
      {"map_saved", map_json(run.options.save_map)},
      {"pairs_refused", info.pairs_refused},
      {"submaps_refused", info.submaps_refused},
      {"focal_px", focal > 0.0 ? Json(focal) : Json(nullptr)},
      {"focal_sigma_px", focal > 0.0 ? Json(run.result.predictor.focal_sigma_px) : Json(nullptr)},
      {"principal_offset_px", principal_json(run.result.predictor)},
      {"readout_ms", run.result.predictor.readout_ms},
      {"lanes", lanes_json(run.result.lanes)},
      {"memory", memory_json(run)},
      {"timing_ms", timing_json(run.result.times)},
      {"wall_s", run.result.wall_s},
      {"fps", frames_per_second(run.result)}};
}

std::string focal_source(const Run& run) {
  if (run.options.settings.geometric.focal_px > 0.0) return "given";
  const unisim_predictor_info& info = run.result.predictor;
  if (!(info.focal_sigma_px > 0.0)) return "estimated";
  return format("estimated +- %.1f %%", 100.0 * info.focal_sigma_px / info.focal_px);
}

std::string summary_text(const Run& run, const std::vector<std::string>& files) {
  const unisim_session_info& info = run.data.session;
  const pipeline::Result& result = run.result;
  std::string out = run.options.sequence + " (" + run.format +
                    "): " + std::to_string(result.progress.frames) + " frames, " +
                    std::to_string(info.keyframes) + " keyframes (" + keyframe_choice(run.options) +
                    "), " + std::to_string(info.submaps) + " submaps, " +
                    format("%.1f %% of the keyframes posed", 100.0 * coverage(run.data));
  const int32_t unposed = info.keyframes - info.posed_keyframes;
  if (unposed > 0) out += " (" + std::to_string(unposed) + " without a pose)";
  if (info.segments > 1) out += ", " + std::to_string(info.segments) + " segments";
  out += "\n" + score_line(run);
  const SegmentScale* known = run.data.main_scale();
  if (known != nullptr) {
    out += format("metric: 1 unit = %.4g m +- %.2g %%, %d distances counted, %d refused\n",
                  known->metres_per_unit, 100.0 * known->sigma, run.data.distances.taken,
                  run.data.distances.refused);
  } else if (!run.data.scales.empty()) {
    out += "relative: only some of the segments have a known scale\n";
  }
  if (result.predictor.focal_px > 0.0) {
    out +=
        format("focal length %.1f px (%s), ", result.predictor.focal_px, focal_source(run).c_str());
  }
  if (result.predictor.readout_ms != 0) {
    const bool told = run.options.settings.geometric.readout_ms != 0;
    out +=
        format("readout %.1f ms (%s), ", result.predictor.readout_ms, told ? "given" : "estimated");
  }
  const pipeline::LatencyHistogram& live = result.times.track_total;
  out +=
      format("%.1f s, %.0f frames/s, live pose of a keyframe %.1f ms (p95 %.1f)\n", result.wall_s,
             frames_per_second(result), live.percentile_ms(0.5), live.percentile_ms(0.95));
  for (const std::string& file : files) out += "wrote " + file + "\n";
  return out;
}

}  // namespace unisim::replay
