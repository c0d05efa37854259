// SPDX-License-Identifier: MIT
// unisim-eval: errors of trajectories and clouds against ground truth.
#include <CLI/CLI.hpp>
#include <map>

#include "drivers/common/format.hpp"
#include "drivers/sequence/folder.hpp"
#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"
#include "tools/common/program.hpp"
#include "tools/eval/ate.hpp"
#include "tools/eval/cloud_metrics.hpp"
#include "tools/eval/print.hpp"
#include "tools/eval/rpe.hpp"
#include "tools/eval/top_view.hpp"

namespace unisim::eval {
namespace {

constexpr const char* kName = "unisim-eval";
constexpr double kVoxel = 0.01;  // metres, unless given, where the truth is made of depth images
constexpr const char* kRollOpen =
    "the positions lie on a straight line: the turn about it is not known, the error does not "
    "depend on it";

struct Arguments {
  std::string ground_truth, estimate, plot;
  std::vector<std::string> trajectories;
  Alignment alignment = Alignment::kSim3;
  double max_dt_s = 0.02;
  double max_distance = 0;
  double voxel = -1;  // below 0: not given
  DepthRequest depth;
  TruthOptions truth;
  std::string trajectory, write_truth;
  std::vector<double> intrinsics;
  RpeStep step;
  bool json = false;
};

void print(const Arguments& arguments, Json result, const Json& notes) {
  if (!notes.empty()) result["notes"] = notes;
  tools::print(arguments.json ? tools::json_text(result, 1) + "\n" : text_of(result));
}

// Both trajectories, and what they leave to be said.
struct Pair {
  Trajectory truth, estimate;
  Json notes = Json::array();
};

void note(const std::string& line, Json* notes) {
  tools::complain(kName, line);
  notes->push_back(line);
}

Pair read_pair(const std::string& truth, const std::string& estimate) {
  Pair pair = {read_trajectory(truth), read_trajectory(estimate)};
  for (const std::string& line : pair.truth.notes) note(line, &pair.notes);
  if (estimate == truth) return pair;
  for (const std::string& line : pair.estimate.notes) note(line, &pair.notes);
  return pair;
}

// What may help, in the options of this program.
const char* advice(ScoreError::Kind kind) {
  switch (kind) {
    case ScoreError::Kind::kNoPairs:
      return "give files with the same clock or a larger --max-dt";
    case ScoreError::Kind::kFewPairs:
    case ScoreError::Kind::kStill:
      return "use --align none or a longer trajectory";
    case ScoreError::Kind::kNoStep:
      return "give a smaller --delta";
    case ScoreError::Kind::kNoTimes:
      return "use --unit frames";
  }
  return "";
}

int run_ate(const Arguments& arguments) {
  Pair pair = read_pair(arguments.ground_truth, arguments.estimate);
  const auto& [truth, estimate, notes] = pair;
  const Ate ate =
      absolute_trajectory_error(truth, estimate, arguments.alignment, arguments.max_dt_s);
  if (ate.T_truth_estimate.roll_open) note(kRollOpen, &pair.notes);
  print(arguments, ate_json({truth, estimate, arguments.alignment, arguments.max_dt_s}, ate),
        notes);
  if (!arguments.plot.empty() && !write_top_view(arguments.plot, truth, ate)) {
    throw tools::Failure(
        tools::kExitLimit,
        arguments.plot + ": cannot write the plot: give a .png in a folder that can be written");
  }
  return tools::kExitDone;
}

int run_rpe(const Arguments& arguments) {
  const auto [truth, estimate, notes] = read_pair(arguments.ground_truth, arguments.estimate);
  const Rpe rpe =
      relative_pose_error(truth, estimate, arguments.alignment, arguments.max_dt_s, arguments.step);
  print(arguments,
        rpe_json({truth, estimate, arguments.alignment, arguments.max_dt_s}, arguments.step, rpe),
        notes);
  return tools::kExitDone;
}

// ESTIMATE is the folder of a run.
int run_consistency(const Arguments& arguments) {
  const std::string table = arguments.estimate + "/keyframes.csv";
  const std::vector<KeyframeClaim> claims = read_keyframe_table(table);
  const auto [truth, estimate, notes] =
      read_pair(arguments.ground_truth, arguments.estimate + "/trajectory.tum");
  const Consistency found = consistency(truth, estimate, claims, arguments.max_dt_s);
  print(arguments, consistency_json({truth, estimate, Alignment::kSim3, arguments.max_dt_s}, found),
        notes);
  return tools::kExitDone;
}

// A line leaves the turn of a cloud open.
Similarity cloud_alignment(const Trajectory& truth, const Trajectory& estimate, double max_dt_s) {
  const Similarity T_truth_estimate =
      absolute_trajectory_error(truth, estimate, Alignment::kSim3, max_dt_s).T_truth_estimate;
  if (T_truth_estimate.roll_open) {
    throw InputError(estimate.name +
                     ": on a straight line: the turn of the cloud about it is not known; give "
                     "trajectories with a bend");
  }
  return T_truth_estimate;
}

// The cloud to compare with, and how the estimate comes to lie beside it.
struct CloudTruth {
  Cloud cloud;
  Similarity T_truth_estimate;
  double voxel = 0;
  Json made = nullptr;  // how, where it is from depth images
  Json notes = Json::array();
};

CloudTruth read_truth(const Arguments& arguments) {
  CloudTruth truth;
  if (!arguments.trajectories.empty()) {
    const Pair pair = read_pair(arguments.trajectories[0], arguments.trajectories[1]);
    truth.notes = pair.notes;
    truth.T_truth_estimate = cloud_alignment(pair.truth, pair.estimate, arguments.max_dt_s);
  }
  truth.cloud = read_ply(arguments.ground_truth);
  truth.voxel = std::max(arguments.voxel, 0.0);
  if (truth.voxel > 0) truth.cloud = thinned(truth.cloud, &truth.voxel);
  return truth;
}

CloudTruth make_truth(const Arguments& arguments) {
  CloudTruth truth;
  DepthRequest request = arguments.depth;
  request.path = arguments.ground_truth;
  if (!arguments.intrinsics.empty()) {
    const std::vector<double>& given = arguments.intrinsics;
    request.camera = {given[0], given[1], given[2], given[3], 0.0};
  }
  const DepthImages found = find_depth_images(request);
  for (const std::string& line : found.notes) note(line, &truth.notes);
  TruthOptions options = arguments.truth;
  options.voxel = arguments.voxel > 0 ? arguments.voxel : kVoxel;
  if (!arguments.trajectory.empty()) {
    const Trajectory estimate = read_trajectory(arguments.trajectory);
    for (const std::string& line : estimate.notes) note(line, &truth.notes);
    truth.T_truth_estimate = cloud_alignment(found.truth, estimate, arguments.max_dt_s);
    options.first_s = estimate.poses.front().time_s - arguments.max_dt_s;
    options.last_s = estimate.poses.back().time_s + arguments.max_dt_s;
  }
  TruthCloud made = make_truth(found, options);
  truth.made = truth_json(found, options, made);
  truth.voxel = made.voxel;
  truth.cloud = std::move(made.cloud);
  truth.cloud.name = arguments.ground_truth;
  return truth;
}

int run_cloud(const Arguments& arguments) {
  const bool recording = sequence::is_folder(arguments.ground_truth);
  if (recording && !arguments.trajectories.empty()) {
    throw std::invalid_argument("--trajectories goes with a PLY file: give --trajectory EST");
  }
  if (!recording && !arguments.trajectory.empty()) {
    throw std::invalid_argument("--trajectory goes with a recording: give --trajectories GT EST");
  }
  const CloudTruth truth = recording ? make_truth(arguments) : read_truth(arguments);
  if (!arguments.write_truth.empty() && !write_ply(arguments.write_truth, truth.cloud)) {
    throw tools::Failure(tools::kExitLimit, arguments.write_truth + ": cannot be written");
  }
  Cloud estimate = read_ply(arguments.estimate);
  if (truth.voxel > 0) {
    double side = truth.voxel / truth.T_truth_estimate.s;
    estimate = thinned(estimate, &side);
  }
  const CloudMetrics metrics =
      compare_clouds(truth.cloud, estimate, truth.T_truth_estimate, arguments.max_distance);
  Json result = cloud_json(
      {truth.cloud, estimate, truth.T_truth_estimate, arguments.max_distance, truth.voxel},
      metrics);
  if (!truth.made.is_null()) result["protocol"]["truth"] = truth.made;
  print(arguments, result, truth.notes);
  return tools::kExitDone;
}

// Largest time difference that can be asked for: 30 years.
constexpr double kMaxSeconds = 1e9;
// Largest length that can be asked for: beyond any trajectory, and sums with it stay finite.
constexpr double kMaxLength = 1e300;

// The number must lie in a range. @return what is wrong, "" if nothing
std::string out_of_range(const std::string& text, double low, bool with_low, double high) {
  double value = 0;
  const bool number = sequence::parse_number(text, &value);
  if (number && (with_low ? value >= low : value > low) && value <= high) return "";
  return "'" + text +
         drivers::format("' is not a number %s %g up to %g", with_low ? "from" : "above", low,
                         high);
}

std::string seconds(const std::string& text) { return out_of_range(text, 0, true, kMaxSeconds); }

std::string length(const std::string& text) { return out_of_range(text, 0, true, kMaxLength); }

std::string step_length(const std::string& text) {
  return out_of_range(text, 0, false, kMaxLength);
}

void add_files(CLI::App* command, Arguments* arguments) {
  command->add_option("GT", arguments->ground_truth, "ground truth")->required();
  command->add_option("EST", arguments->estimate, "estimate")->required();
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->add_option("--max-dt", arguments->max_dt_s, "largest time difference of a pair, seconds")
      ->check(seconds, "0 to 1e9")
      ->capture_default_str();
}

// An option that takes one of a few words.
template <typename Value>
void add_choice(CLI::App* command, const std::string& name,
                const std::map<std::string, Value>& choices, Value* value,
                const std::string& help) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto set = [value, choices](const std::string& word) { *value = choices.at(word); };
  command->add_option_function<std::string>(name, set, help)->check(CLI::IsMember(words));
}

void add_alignment(CLI::App* command, Arguments* arguments) {
  const std::map<std::string, Alignment> choices = {
      {"none", Alignment::kNone}, {"se3", Alignment::kSe3}, {"sim3", Alignment::kSim3}};
  add_choice(command, "--align", choices, &arguments->alignment,
             "alignment of the estimate (default sim3)");
}

void add_depth_options(CLI::App* cloud, Arguments* arguments) {
  cloud->add_option("--trajectory", arguments->trajectory,
                    "GT is a recording: align as these poses align with its true ones (sim3), and "
                    "take depth images of their time");
  cloud->add_option("--format", arguments->depth.format, "of the recording: tum, 7scenes, replica")
      ->capture_default_str();
  cloud->add_option("--ground-truth", arguments->depth.ground_truth,
                    "poses of the depth images, instead of the recording's");
  cloud
      ->add_option("--intrinsics", arguments->intrinsics, "fx,fy,cx,cy of the depth images, pixels")
      ->delimiter(',')
      ->expected(4);
  cloud
      ->add_option("--depth-units", arguments->depth.units_per_metre,
                   "of the depth images, a metre")
      ->check(step_length, "above 0");
  cloud->add_option("--every", arguments->truth.every, "take every n-th depth image")
      ->check(CLI::Range(int64_t{1}, int64_t{1000000}));
  cloud
      ->add_option("--max-depth", arguments->truth.max_depth,
                   "leave out farther pixels, metres (0: none)")
      ->check(length, "0 or more");
  cloud->add_option("--write-truth", arguments->write_truth, "keep the true cloud as PLY");
}

void add_cloud(CLI::App* app, Arguments* arguments) {
  CLI::App* cloud = app->add_subcommand(
      "cloud",
      "accuracy, completeness and Chamfer distance of a PLY file against another, or against the "
      "depth images of a recording");
  add_files(cloud, arguments);
  cloud
      ->add_option("--trajectories", arguments->trajectories,
                   "GT EST: align the cloud as these trajectories align (sim3)")
      ->expected(2);
  cloud
      ->add_option("--max-distance", arguments->max_distance,
                   "larger distances count as this (0: no limit)")
      ->check(length, "0 or more");
  cloud
      ->add_option("--voxel", arguments->voxel,
                   "thin both to one point per cube of this side, metres (default: 0.01 with a "
                   "recording, else not)")
      ->check(step_length, "above 0");
  add_depth_options(cloud, arguments);
}

void add_commands(CLI::App* app, Arguments* arguments) {
  app->require_subcommand(1);
  CLI::App* ate =
      app->add_subcommand("ate", "absolute trajectory error of TUM, KITTI or EuRoC csv files");
  add_files(ate, arguments);
  add_alignment(ate, arguments);
  ate->add_option("--plot", arguments->plot, "write both trajectories from above as PNG");

  CLI::App* rpe = app->add_subcommand("rpe", "relative pose error over a step");
  add_files(rpe, arguments);
  add_alignment(rpe, arguments);
  rpe->add_option("--delta", arguments->step.delta, "length of the step")
      ->check(step_length, "above 0")
      ->capture_default_str();
  const std::map<std::string, StepUnit> units = {
      {"frames", StepUnit::kFrames}, {"m", StepUnit::kMetres}, {"s", StepUnit::kSeconds}};
  add_choice(rpe, "--unit", units, &arguments->step.unit, "of the step (default frames)");
  rpe->add_flag("--all-pairs", arguments->step.all_pairs, "a step from every pose");

  add_cloud(app, arguments);

  CLI::App* belief = app->add_subcommand(
      "consistency",
      "errors of keyframes over the standard deviations a run of unisim-replay gives them, EST "
      "being its folder: both beside the other keyframes of a segment, after alignment (sim3)");
  add_files(belief, arguments);
}

int run(int argc, const char* const* argv) {
  Arguments arguments;
  CLI::App app("Errors of a trajectory or a cloud against ground truth");
  app.set_version_flag("--version", UNISIM_EVAL_VERSION);
  add_commands(&app, &arguments);
  if (!tools::parse(&app, argc, argv)) return tools::kExitDone;
  try {
    if (app.got_subcommand("ate")) return run_ate(arguments);
    if (app.got_subcommand("consistency")) return run_consistency(arguments);
    return app.got_subcommand("rpe") ? run_rpe(arguments) : run_cloud(arguments);
  } catch (const ScoreError& error) {
    throw tools::Failure(tools::kExitInput,
                         std::string(error.what()) + ": " + advice(error.kind()));
  } catch (const InputError& error) {
    throw tools::Failure(tools::kExitInput, error.what());
  } catch (const std::invalid_argument& error) {
    throw tools::Failure(tools::kExitUsage, std::string(error.what()) + ": see unisim-eval --help");
  }
}

}  // namespace
}  // namespace unisim::eval

int main(int argc, char** argv) {
  return unisim::tools::run_program(unisim::eval::kName,
                                    [&] { return unisim::eval::run(argc, argv); });
}
