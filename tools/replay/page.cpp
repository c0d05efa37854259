// SPDX-License-Identifier: MIT
// What of a run goes on report.html.
#include "tools/replay/page.hpp"

#include <algorithm>

#include "drivers/common/format.hpp"
#include "drivers/pipeline/stages.hpp"
#include "tools/replay/report/local_scale.hpp"
#include "tools/replay/version.hpp"

namespace unisim::replay {
namespace {

using drivers::format;
using report::Point;
using report::Sample;

constexpr double kNsPerSecond = 1e9;

Point point_at(double time_s, const Eigen::Vector3d& p, int segment = 0) {
  return {time_s, p.x(), p.y(), p.z(), segment};
}

/// Into the frame of the ground truth where there is one.
Point placed(int64_t time_ns, const unisim_sim3& T, const std::optional<eval::Ate>& ate,
             int segment) {
  const Eigen::Vector3d p(T.t[0], T.t[1], T.t[2]);
  const double time_s = static_cast<double>(time_ns) / kNsPerSecond;
  return point_at(time_s, ate ? ate->T_truth_estimate * p : p, segment);
}

/// Ground truth of the time the run covers.
std::vector<Point> truth_points(const Run& run) {
  std::vector<Point> points;
  if (!run.scores.ate || run.data.trajectory.empty()) return points;
  const double first = static_cast<double>(run.data.trajectory.front().timestamp_ns) / kNsPerSecond;
  const double last = static_cast<double>(run.data.trajectory.back().timestamp_ns) / kNsPerSecond;
  for (const eval::Pose& pose : run.truth.poses) {
    if (pose.time_s >= first && pose.time_s <= last)
      points.push_back(point_at(pose.time_s, pose.t));
  }
  return points;
}

std::vector<Sample> errors(const std::optional<eval::Ate>& ate) {
  std::vector<Sample> samples;
  if (!ate) return samples;
  for (size_t k = 0; k < ate->distance.size(); ++k) {
    samples.push_back({ate->time_s[k], ate->distance[k], 0});
  }
  return samples;
}

std::vector<Sample> scales(const std::optional<eval::Ate>& ate) {
  std::vector<Point> estimate;
  std::vector<Point> truth;
  if (!ate) return {};
  for (size_t k = 0; k < ate->time_s.size(); ++k) {
    estimate.push_back(point_at(ate->time_s[k], ate->aligned_position[k]));
    truth.push_back(point_at(ate->time_s[k], ate->truth_position[k]));
  }
  return report::local_scale(estimate, truth);
}

void add_tracks(const Run& run, report::ReportData* page) {
  for (const KeyframeRow& row : run.data.keyframes) {
    if (row.pose.confidence == 0) continue;
    page->estimate.push_back(
        placed(row.pose.timestamp_ns, row.pose.T_world_kf, run.scores.ate, row.pose.segment));
  }
  for (const unisim_stamped_pose& live : run.data.live) {
    page->live.push_back(placed(live.timestamp_ns, live.T_world_cam, run.scores.live, 0));
  }
  page->truth = truth_points(run);
  page->length_unit = run.scores.ate || run.data.metric ? "m" : "";
  page->error = errors(run.scores.ate);
  page->live_error = errors(run.scores.live);
  page->scale = scales(run.scores.ate);
}

void add_figures(const Run& run, report::ReportData* page) {
  const Scores& scores = run.scores;
  const auto millimetres = [](double metres) { return format("%.1f mm", 1000.0 * metres); };
  if (scores.ate) {
    page->figures.push_back(
        {"ATE, final poses", millimetres(scores.ate->error.rmse),
         format("RMSE of %zu %s", scores.ate->pairs.size(), scores.poses.c_str())});
  }
  if (scores.live) {
    page->figures.push_back(
        {"ATE, live poses", millimetres(scores.live->error.rmse), "as first given out"});
  }
  if (run.result.predictor.focal_px > 0.0) {
    page->figures.push_back(
        {"focal length", format("%.1f px", run.result.predictor.focal_px), focal_source(run)});
  }
  const SegmentScale* known = run.data.main_scale();
  if (known != nullptr) {
    page->figures.push_back({"scale", format("metric, %.2g %%", 100.0 * known->sigma),
                             format("1 unit = %.4g m, %d distances", known->metres_per_unit,
                                    run.data.distances.taken)});
  }
  page->figures.push_back({"keyframes posed", format("%.1f %%", 100.0 * coverage(run.data)),
                           format("of %d, %d without", run.data.session.keyframes,
                                  run.data.session.keyframes - run.data.session.posed_keyframes)});
  page->figures.push_back({"speed",
                           format("%.0f frames/s", static_cast<double>(run.result.progress.frames) /
                                                       std::max(run.result.wall_s, 1e-9)),
                           format("%.1f s in all", run.result.wall_s)});
}

/// "2: 60 keyframes (ATE 4.1 mm), 12 keyframes"
std::string segments_text(const Scores& scores) {
  std::string line = std::to_string(scores.segments.size());
  if (scores.segments.size() < 2) return line;
  for (const SegmentScore& segment : scores.segments) {
    line += (&segment == &scores.segments.front() ? ": " : ", ") +
            format("%d keyframes", segment.keyframes);
    if (segment.ate_rmse_m) line += format(" (ATE %.1f mm)", 1000.0 * *segment.ate_rmse_m);
  }
  return line;
}

void add_protocol(const Run& run, report::ReportData* page) {
  const Options& o = run.options;
  const unisim_session_info& info = run.data.session;
  page->protocol = {
      {"sequence", o.sequence + " (" + run.format + ")"},
      {"frames", format("%lld tracked, %lld unreadable, %lld dropped",
                        static_cast<long long>(run.result.progress.frames),
                        static_cast<long long>(run.result.progress.frames_bad),
                        static_cast<long long>(run.result.progress.frames_dropped))},
      {"keyframes", format("%d, ", info.keyframes) + keyframe_choice(o)},
      {"submaps", format("%d of %d keyframes, overlap %d", info.submaps,
                         o.settings.session.window_size, o.settings.session.window_overlap)},
      {"segments", segments_text(run.scores)},
      {"predictor", o.predictor},
      {"loops",
       format("%d counted of %d old keyframes compared, %d times found again after a loss, "
              "%d segments joined",
              run.result.predictor.loops_accepted, run.result.predictor.loops_tried,
              run.result.predictor.relocalised, run.result.predictor.joined)},
      {"intrinsics", o.settings.geometric.focal_px > 0.0 ? "given" : "estimated"},
      {"ground truth", run.truth.name.empty() ? "none" : run.truth.name},
      {"alignment", "Sim(3), final and live poses each by themselves"}};
}

void add_tables(const Run& run, report::ReportData* page) {
  for (const pipeline::Stage& stage : pipeline::kStages) {
    const pipeline::LatencyHistogram& times = run.result.times.*stage.times;
    if (times.count() == 0) continue;
    page->timing.push_back({stage.name, times.count(), times.percentile_ms(0.5),
                            times.percentile_ms(0.95), times.max_ms()});
  }
  const auto mebibytes = [](double bytes) { return format("%.1f MiB", bytes / (1 << 20)); };
  page->memory = {{"session", mebibytes(static_cast<double>(run.data.session.arena_bytes))},
                  {"predictor", mebibytes(static_cast<double>(run.result.predictor.state_bytes))},
                  {"process, at most", mebibytes(static_cast<double>(process_peak_bytes()))}};
  if (run.result.heap_calls >= 0) {
    page->memory.push_back({"heap calls of the library", std::to_string(run.result.heap_calls)});
  }
}

}  // namespace

report::ReportData page_data(const Run& run, const std::vector<std::string>& messages) {
  report::ReportData page;
  page.title = run.options.sequence;
  page.subtitle = run.options.predictor + " predictor, keyframes " + keyframe_choice(run.options);
  page.footer = "unisim-replay " + version_text();
  add_tracks(run, &page);
  add_figures(run, &page);
  add_protocol(run, &page);
  add_tables(run, &page);
  page.warnings = messages;
  if (!run.result.message.empty()) page.warnings.push_back(run.result.message);
  if (!run.scores.problem.empty()) page.warnings.push_back(run.scores.problem);
  return page;
}

}  // namespace unisim::replay
