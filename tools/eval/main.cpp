// SPDX-License-Identifier: MIT
// unisim-eval: errors of trajectories and clouds against ground truth.
#include <CLI/CLI.hpp>
#include <map>

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

struct Arguments {
  std::string ground_truth, estimate, plot;
  std::vector<std::string> trajectories;
  Alignment alignment = Alignment::kSim3;
  double max_dt_s = 0.02;
  double max_distance = 0;
  RpeStep step;
  bool json = false;
};

void print(const Arguments& arguments, const Json& result) {
  tools::print(arguments.json ? tools::json_text(result, 1) + "\n" : text_of(result));
}

int run_ate(const Arguments& arguments) {
  const Trajectory truth = read_trajectory(arguments.ground_truth);
  const Trajectory estimate = read_trajectory(arguments.estimate);
  const Ate ate =
      absolute_trajectory_error(truth, estimate, arguments.alignment, arguments.max_dt_s);
  print(arguments, ate_json({truth, estimate, arguments.alignment, arguments.max_dt_s}, ate));
  if (!arguments.plot.empty() && !write_top_view(arguments.plot, truth, ate)) {
    throw tools::Failure(
        tools::kExitLimit,
        arguments.plot + ": cannot write the plot: give a .png in a folder that can be written");
  }
  return tools::kExitDone;
}

int run_rpe(const Arguments& arguments) {
  const Trajectory truth = read_trajectory(arguments.ground_truth);
  const Trajectory estimate = read_trajectory(arguments.estimate);
  const Rpe rpe =
      relative_pose_error(truth, estimate, arguments.alignment, arguments.max_dt_s, arguments.step);
  print(arguments,
        rpe_json({truth, estimate, arguments.alignment, arguments.max_dt_s}, arguments.step, rpe));
  return tools::kExitDone;
}

int run_cloud(const Arguments& arguments) {
  Similarity T_truth_estimate;
  if (!arguments.trajectories.empty()) {
    const Trajectory truth = read_trajectory(arguments.trajectories[0]);
    const Trajectory estimate = read_trajectory(arguments.trajectories[1]);
    T_truth_estimate =
        absolute_trajectory_error(truth, estimate, Alignment::kSim3, arguments.max_dt_s)
            .T_truth_estimate;
  }
  const Cloud truth = read_ply(arguments.ground_truth);
  const Cloud estimate = read_ply(arguments.estimate);
  const CloudMetrics metrics =
      compare_clouds(truth, estimate, T_truth_estimate, arguments.max_distance);
  print(arguments, cloud_json(truth, estimate, T_truth_estimate, arguments.max_distance, metrics));
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
  char range[80];
  std::snprintf(range, sizeof range, "' is not a number %s %g up to %g",
                with_low ? "from" : "above", low, high);
  return "'" + text + range;
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

  CLI::App* cloud =
      app->add_subcommand("cloud", "accuracy, completeness and Chamfer distance of PLY files");
  add_files(cloud, arguments);
  cloud
      ->add_option("--trajectories", arguments->trajectories,
                   "GT EST: align the cloud as these trajectories align (sim3)")
      ->expected(2);
  cloud
      ->add_option("--max-distance", arguments->max_distance,
                   "larger distances count as this (0: no limit)")
      ->check(length, "0 or more");
}

int run(int argc, const char* const* argv) {
  Arguments arguments;
  CLI::App app("Errors of a trajectory or a cloud against ground truth");
  app.set_version_flag("--version", UNISIM_EVAL_VERSION);
  add_commands(&app, &arguments);
  if (!tools::parse(&app, argc, argv)) return tools::kExitDone;
  try {
    if (app.got_subcommand("ate")) return run_ate(arguments);
    return app.got_subcommand("rpe") ? run_rpe(arguments) : run_cloud(arguments);
  } catch (const InputError& error) {
    throw tools::Failure(tools::kExitInput, error.what());
  } catch (const std::invalid_argument& error) {
    throw tools::Failure(tools::kExitUsage, std::string(error.what()) + ": see unisim-eval --help");
  }
}

}  // namespace
}  // namespace unisim::eval

int main(int argc, char** argv) {
  return unisim::tools::run_program("unisim-eval", [&] { return unisim::eval::run(argc, argv); });
}
