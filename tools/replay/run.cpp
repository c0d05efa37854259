// SPDX-License-Identifier: MIT
// One run: a source, a predictor, results.
#include "tools/replay/run.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "drivers/common/has_places.hpp"
#include "drivers/pipeline/session_defaults.hpp"
#include "drivers/recorded/recorded.h"
#include "drivers/sequence/text_file.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/heap_counter.hpp"
#include "tools/common/json_text.hpp"
#include "tools/common/output.hpp"
#include "tools/replay/cloud.hpp"
#include "tools/replay/inputs.hpp"
#include "tools/replay/lcm_output.hpp"
#include "tools/replay/live_trajectory.hpp"
#include "tools/replay/localised.hpp"
#include "tools/replay/maps.hpp"
#include "tools/replay/output_folder.hpp"
#include "tools/replay/page.hpp"
#include "tools/replay/pose_files.hpp"
#include "tools/replay/progress_line.hpp"
#include "tools/replay/report/report.hpp"
#include "tools/replay/run_data.hpp"
#include "tools/replay/run_record.hpp"
#include "tools/replay/scores.hpp"
#include "tools/replay/summary.hpp"

namespace unisim::replay {
namespace {

// Length of the map when that of the sequence is not known (some videos).
constexpr int32_t kUnknownLengthKeyframes = 1024;

std::vector<std::string> output_names(const Options& options) {
  std::vector<std::string> names = {"trajectory.tum", "trajectory_live.tum", "keyframes.csv",
                                    "places.csv", "summary.json"};
  names.emplace_back("map.ply");
  if (options.settings.pipeline.every_frame) names.emplace_back("trajectory_frames.tum");
  if (!options.load_map.empty()) names.emplace_back("trajectory_map.tum");
  if (options.report) names.emplace_back("report.html");
  return names;
}

ProgressLine::Style progress_style(const Options& options) {
  if (options.json) return ProgressLine::Style::kJson;
  if (options.quiet) return ProgressLine::Style::kNone;
  return isatty(STDERR_FILENO) != 0 ? ProgressLine::Style::kTerminal : ProgressLine::Style::kLines;
}

int exit_code(pipeline::Preparation::Answer answer) {
  using Answer = pipeline::Preparation::Answer;
  switch (answer) {
    case Answer::kReady:
      return tools::kExitDone;
    case Answer::kBadConfiguration:
      return tools::kExitUsage;
    case Answer::kNoMemory:
      return tools::kExitLimit;
    case Answer::kFailed:
      break;
  }
  return tools::kExitOther;
}

void prepare(pipeline::Pipeline* pipeline) {
  const pipeline::Preparation preparation = pipeline->prepare();
  if (preparation.answer == pipeline::Preparation::Answer::kReady) return;
  throw tools::Failure(exit_code(preparation.answer), preparation.message);
}

/// A recording of the geometric predictor is filtered as the predictor itself: the same map.
CloudOptions cloud_options(unisim_predictor* predictor) {
  CloudOptions options;
  options.predictor = unisim_predictor_inside(predictor);
  unisim_predictor_recorded_size(predictor, &options.image_width, &options.image_height);
  const bool geometric = std::string_view(unisim_predictor_origin(predictor)) == "geometric";
  if (geometric) {
    options.min_confidence = kGeometricConfidence;
    options.sure_confidence = kGeometricSure;
    options.one_camera = true;
  }
  options.voxel = kVoxelShare;
  return options;
}

/// The map is drawn in the frame of trajectory.tum.
void write_map(const Run& run, const Cloud& cloud, OutputFolder* folder) {
  folder->write("map.ply", [&](const std::filesystem::path& path) {
    const unisim_predictor_info& predictor = run.result.predictor;
    cloud.write(
        path, run.data,
        {predictor.radial_k1, predictor.focal_px, predictor.center_x_px, predictor.center_y_px});
  });
}

void write_page(const Run& run, const std::vector<std::string>& messages, OutputFolder* folder) {
  if (!run.options.report) return;
  folder->write_text("report.html", report::report_html(page_data(run, messages)));
}

/// A recording that fails is bad input; a predictor that computes fails like a device.
int exit_code(pipeline::Outcome outcome, const Options& options) {
  switch (outcome) {
    case pipeline::Outcome::kFinished:
      return tools::kExitDone;
    case pipeline::Outcome::kSourceFailed:
      return tools::kExitInput;
    case pipeline::Outcome::kPredictorFailed:
      return options.predictor == "recorded" ? tools::kExitInput : tools::kExitLimit;
    case pipeline::Outcome::kCapacity:
      return tools::kExitLimit;
    case pipeline::Outcome::kStopped:
    case pipeline::Outcome::kSessionFailed:
      return tools::kExitOther;
  }
  return tools::kExitOther;
}

/// What a run has come to.
struct RunState {
  const Options& options;
  const pipeline::Result& result;
  unisim_session* session;
  const eval::Trajectory& truth;
  const std::string& format;
  std::string recorder_problem;
  std::string publishing_problem;
  const unisim_session_info& before;
  const std::string* map_problem;  ///< why --save-map saved nothing, NULL where none is asked for
};

void say_problem(const Options& options, const std::string& line) {
  tools::complain(options.program, line);
}

/// The images were read and no keyframe got a pose: what the predictor saw, or what is known here.
std::string why_no_pose(const pipeline::Result& result) {
  if (result.predictor.no_start != nullptr) return result.predictor.no_start;
  const int32_t keyframes = result.progress.keyframes;
  return "no keyframe has a pose: " + std::to_string(result.progress.frames) + " frames, " +
         std::to_string(keyframes) +
         (keyframes < 2 ? " keyframes; a pose takes two or more: lower --stride"
                        : " keyframes, none with a usable prediction");
}

/// The run left no pose: says why.
int report_nothing(const pipeline::Result& result, const Options& options) {
  std::string line = result.message;
  int code = exit_code(result.outcome, options);
  if (result.outcome == pipeline::Outcome::kFinished) {
    code = tools::kExitInput;
    const pipeline::Progress& progress = result.progress;
    if (progress.frames == 0) {
      line = "no readable frame among " + std::to_string(progress.frames_bad) +
             "; give a sequence with images";
    } else {
      line = why_no_pose(result);
    }
  } else {
    if (result.predictor.no_start != nullptr) line += "; " + why_no_pose(result);
    line += "; no pose was known yet, nothing is written";
  }
  say_problem(options, line);
  return code;
}

void write_files(const Run& run, const RunRecord& record, OutputFolder* folder) {
  const double scale = run.scores.ate ? run.scores.ate->T_truth_estimate.s : 0.0;
  const SegmentScale* known = run.data.main_scale();
  folder->write_text("trajectory.tum",
                     trajectory_text("keyframes, final poses", run.data.trajectory, scale, known));
  if (run.options.settings.pipeline.every_frame) {
    folder->write_text("trajectory_frames.tum",
                       trajectory_text("all frames, final poses", run.data.frames, scale, known));
  }
  if (!run.options.load_map.empty()) {
    folder->write_text("trajectory_map.tum",
                       trajectory_text("keyframes of the map, of earlier runs first, final poses",
                                       run.data.map, scale, known));
  }
  folder->write_text("keyframes.csv", keyframe_table(run.data));
  folder->write_text("places.csv", place_table(record.places(), run.result.predictor));
  folder->write_text("summary.json", tools::json_text(summary_json(run), 1) + "\n");
}

void print_result(const Run& run, const OutputFolder& folder) {
  if (run.options.json) {
    tools::print(
        tools::json_text(
            {{"type", "result"}, {"files", folder.written()}, {"summary", summary_json(run)}}) +
        "\n");
    return;
  }
  tools::print(summary_text(run, folder.written()));
}

/// Prints what went wrong on the way; the first reason decides the exit code. A score that cannot
/// be had is none: the map is there.
int conclude(const Run& run, const OutputFolder& folder, const RunState& state) {
  int code = exit_code(run.result.outcome, run.options);
  const auto add = [&](int reason, const std::string& line) {
    if (line.empty()) return;
    if (code == tools::kExitDone) code = reason;
    say_problem(run.options, line);
  };
  if (!run.result.message.empty()) {
    say_problem(run.options, run.result.message + "; what was known is written");
  }
  for (const std::string& line : folder.failures()) add(tools::kExitLimit, line);
  add(tools::kExitLimit, state.recorder_problem);
  add(tools::kExitLimit, state.publishing_problem);
  if (!run.scores.problem.empty()) say_problem(run.options, run.scores.problem);
  return code;
}

/// Files of a run that has an output folder, and what listens to the run for them.
class Results {
 public:
  explicit Results(const Options& options)
      : folder_(options.out, output_names(options), options.force),
        record_(options.out),
        live_(folder_.path_of("trajectory_live.tum")) {}

  /// The listeners, once the predictor is known.
  std::vector<pipeline::Listener*> listen(unisim_predictor* predictor, const Options& options) {
    cloud_.emplace(cloud_options(predictor), options.out);
    return {&record_, &live_, &*cloud_};
  }

  /// Writes what the run gave. @return exit code
  int write(const RunState& state, const std::vector<std::string>& messages) {
    const Options& options = state.options;
    const RunData data =
        collect(state.session, record_, options.settings.pipeline.every_frame, state.before);
    if (data.trajectory.empty()) return report_nothing(state.result, options);
    const Scores scores = score(state.truth, data);
    const Run run = {options, state.result, data, state.truth, scores, state.format};
    folder_.add(live_.path(), live_.problem());
    write_files(run, record_, &folder_);
    write_map(run, *cloud_, &folder_);
    write_page(run, messages, &folder_);
    if (state.map_problem != nullptr) folder_.add(options.save_map, *state.map_problem);
    print_result(run, folder_);
    return conclude(run, folder_, state);
  }

 private:
  OutputFolder folder_;
  RunRecord record_;
  LiveTrajectory live_;
  std::optional<Cloud> cloud_;
};

/// @param earlier keyframes of the map that is gone on with
unisim_config session_config(const Options& options, const Settings& settings,
                             unisim_source* source, const unisim_predictor& predictor,
                             int32_t earlier) {
  unisim_config config = settings.session;
  if (options.settings.max_keyframes_given) return config;
  const pipeline::Options& how = options.settings.pipeline;
  const int32_t places = drivers::has_places(predictor) ? how.loops.places : 0;
  config.max_keyframes =
      std::max(pipeline::keyframe_capacity(config, source->frame_count(source), how.keyframes,
                                           kUnknownLengthKeyframes, places),
               least_keyframes(config));
  // A full batch keeps all of them.
  if (config.window_submaps == 0) config.max_keyframes += earlier;
  return config;
}

std::optional<pipeline::Odometry> read_odometry(const std::string& path) {
  if (path.empty()) return std::nullopt;
  try {
    return pipeline::Odometry::read(path);
  } catch (const sequence::InputError& error) {
    throw tools::Failure(tools::kExitInput, std::string("--odometry: ") + error.what());
  }
}

/// The end of a run that writes nothing.
int conclude(const pipeline::Result& result, const Options& options,
             std::initializer_list<std::string> problems) {
  int code = exit_code(result.outcome, options);
  if (!result.message.empty()) say_problem(options, result.message);
  if (result.predictor.no_start != nullptr) say_problem(options, result.predictor.no_start);
  for (const std::string& problem : problems) {
    if (problem.empty()) continue;
    say_problem(options, problem);
    if (code == tools::kExitDone) code = tools::kExitLimit;
  }
  return code;
}

void tell(const std::vector<std::string>& notes, ProgressLine* progress) {
  for (const std::string& note : notes) {
    if (!note.empty()) progress->on_message(note);
  }
}

void end_source(const Surroundings& around, const pipeline::Result& result, Input* input) {
  if (around.ended) around.ended(input->source.get());
  // Its last call may still come back.
  if (result.source_held) static_cast<void>(input->source.release());
}

}  // namespace

int run(const Options& options, const Surroundings& around, const std::atomic<bool>& stop) {
  std::optional<mapfile::MapFile> map = open_map(options);
  std::optional<Results> results;
  std::optional<LocalisedFrames> located;
  if (!options.out.empty() && options.localise) located.emplace(options);
  if (!options.out.empty() && !options.localise) results.emplace(options);
  LcmOutput lcm(options);
  const std::optional<pipeline::Odometry> odometry = read_odometry(options.odometry);
  Input input = around.open();
  const std::string format = input.source->format;
  Settings settings = options.settings;
  Options opened = options;
  opened.live_size = input.live_size;
  const PredictorPtr predictor = open_predictor(opened, &settings, &input.notes);
  const int32_t earlier = map ? map->about().keyframes : 0;
  const unisim_config config =
      session_config(options, settings, input.source.get(), *predictor, earlier);
  ProgressLine progress(progress_style(options), around.line);
  tell(input.notes, &progress);
  std::vector<pipeline::Listener*> listeners = {&progress};
  if (results) {
    const auto own = results->listen(predictor.get(), options);
    listeners.insert(listeners.end(), own.begin(), own.end());
  }
  if (located) listeners.push_back(&*located);
  listeners.insert(listeners.end(), input.listeners.begin(), input.listeners.end());
  if (lcm.listener() != nullptr) listeners.push_back(lcm.listener());
  pipeline::Options how = options.settings.pipeline;
  how.odometry = {nullptr, options.odometry_sigma, 0.0, around.odometry};
  if (odometry) {
    const double usual = odometry->has_positions() ? 0.0 : pipeline::kPathCommonSigma;
    how.odometry = {&*odometry, options.odometry_sigma, options.odometry_common.value_or(usual)};
  }
  // The map has colours, also with no need of images.
  how.decode_images = results.has_value() || options.lcm_images;
  how.localise = options.localise;
  if (!options.save_map.empty()) how.retired_folder = options.out;
  pipeline::Pipeline pipeline(how, input.source.get(), predictor.get(), config, listeners, &stop,
                              tools::heap_counter());
  prepare(&pipeline);
  if (map) hand_over(&*map, &pipeline);
  map.reset();
  lcm.attach(pipeline);
  if (around.starts) around.starts(pipeline, predictor.get());
  const pipeline::Result& result = pipeline.run();
  progress.finish();
  lcm.finish();
  end_source(around, result, &input);
  if (located) {
    const int code = conclude(result, options, {lcm.problem()});
    const int written = located->write(result, input.truth, format);
    return code == tools::kExitDone ? written : code;
  }
  const std::string map_problem = save_map(options, pipeline, predictor.get());
  if (!results) return conclude(result, options, {lcm.problem(), map_problem});
  const RunState state = {options,
                          result,
                          pipeline.session(),
                          input.truth,
                          format,
                          recorder_problem(options, predictor.get()),
                          lcm.problem(),
                          pipeline.before(),
                          options.save_map.empty() ? nullptr : &map_problem};
  return results->write(state, progress.messages());
}

}  // namespace unisim::replay
