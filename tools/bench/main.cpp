// SPDX-License-Identifier: MIT
// unisim-bench: times and memory of the solver, of a session on a long walk, of depth ratios,
// places and the lanes of the pipeline.
#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "drivers/sequence/text_file.hpp"
#include "tools/bench/depth/depth_command.hpp"
#include "tools/bench/lanes/lanes_command.hpp"
#include "tools/bench/places/places_command.hpp"
#include "tools/bench/solver/covariance_command.hpp"
#include "tools/bench/solver/solver_command.hpp"
#include "tools/bench/solver/update_command.hpp"
#include "tools/bench/walk/walk_command.hpp"
#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/program.hpp"
#include "tools/replay/version.hpp"

namespace {

using namespace unisim::bench;
using unisim::tools::in_range;
using unisim::tools::Range;

// More than anybody waits for, and sums of as many stay within their type.
constexpr int64_t kMany = 1000000;
constexpr int64_t kLargestSeed = 1000000000000000;  // exact as a double too
// Beyond any sensible damping or step, and its square is finite.
constexpr double kLarge = 1e100;

void add_solver(CLI::App* app, SolverSettings* settings) {
  CLI::App* command = app->add_subcommand("solver", "Solve a pose graph of a file");
  command->add_option("graph", settings->graph, "GRAPH.usg or GRAPH.g2o")->required();
  command->add_option("--repeat", settings->repeat, "runs, one result each")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_option("--max-iterations", settings->max_iterations, "cap of one run")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_option("--initial-lambda", settings->initial_lambda, "start damping")
      ->transform(in_range(Range::above(0.0, kLarge)));
  command->add_flag("--json", settings->json, "one line of JSON per run");
}

void add_updates(CLI::App* app, UpdateSettings* settings) {
  CLI::App* command =
      app->add_subcommand("updates", "Live updates of a pose graph that arrives submap by submap");
  command->add_option("graph", settings->graph, "GRAPH.usg")->required();
  command->add_option("--from", settings->from, "keyframes there are before an update counts")
      ->transform(in_range(Range::whole(0, kMany)));
  command->add_option("--iterations", settings->iterations, "of each update")
      ->transform(in_range(Range::whole(1, kMany)));
  command
      ->add_option("--least-move", settings->least_move,
                   "nodes that would move less stay; 0: everything is computed anew each time")
      ->transform(in_range(Range::number(0.0, kLarge)));
  command
      ->add_option("--relinearize", settings->relinearize,
                   "edges that have changed less keep their part of H; 0: none does")
      ->transform(in_range(Range::number(0.0, kLarge)));
  command->add_flag("--json", settings->json, "one line of JSON");
}

void add_covariance(CLI::App* app, CovarianceSettings* settings) {
  CLI::App* command =
      app->add_subcommand("covariance", "Covariances of a pose graph: of one pose and of all");
  command->add_option("graph", settings->graph, "GRAPH.usg or GRAPH.g2o")->required();
  command->add_option("--repeat", settings->repeat, "measurements, their median is shown")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_flag("--json", settings->json, "one line of JSON");
}

CLI::CheckedTransformer on_off() {
  return CLI::CheckedTransformer(std::map<std::string, bool>{{"on", true}, {"off", false}});
}

void add_ablations(CLI::App* command, WalkSettings* settings) {
  command->add_option("--overlap", settings->overlap, "keyframes that consecutive windows share")
      ->transform(in_range(Range::whole(0, 8)));
  command->add_option("--preset", settings->preset, "consistent or paper")
      ->transform(CLI::CheckedTransformer(std::map<std::string, int32_t>{
          {"consistent", UNISIM_PRESET_CONSISTENT}, {"paper", UNISIM_PRESET_PAPER}}));
  const std::map<std::string, uint32_t> factors = {
      {"e2v", UNISIM_FACTOR_TWO_VIEW},
      {"anchor", UNISIM_FACTOR_SCALE_ANCHOR},
      {"bridge", UNISIM_FACTOR_BRIDGE},
      {"tie", UNISIM_FACTOR_TIE},
      {"scale", UNISIM_FACTOR_SCALE},
      {"v2s", UNISIM_FACTOR_BRIDGE | UNISIM_FACTOR_SCALE_ANCHOR},
      {"s2s", UNISIM_FACTOR_TIE | UNISIM_FACTOR_SCALE}};
  command
      ->add_option_function<std::string>(
          "--disable",
          [settings, factors](const std::string& name) {
            settings->disabled_factors |= factors.at(name);
          },
          "leave a kind of factor out, as unisim-replay does")
      ->check(CLI::IsMember(factors));
  command
      ->add_option("--scale-noise", settings->scale_noise,
                   "more noise of the depth scale of each view, sigma of its logarithm")
      ->transform(in_range(Range::number(0.0, 1.0)));
  command
      ->add_option("--depth-noise", settings->depth_noise,
                   "more noise of each depth, relative sigma")
      ->transform(in_range(Range::number(0.0, 1.0)));
  command->add_option("--holes", settings->holes, "share of pixels without depth")
      ->transform(in_range(Range::number(0.0, 0.9)));
}

void add_window(CLI::App* app, WalkSettings* settings, bool* json) {
  using unisim::simulator::WorldKind;
  CLI::App* command = app->add_subcommand("window", "A simulated walk through a session");
  command->add_option("--keyframes", settings->keyframes, "length of the walk")
      ->required()
      ->transform(in_range(Range::whole(32, 65536)));
  command->add_option("--seed", settings->seed, "of world and predictions")
      ->transform(in_range(Range::whole(0, kLargestSeed)));
  command->add_option("--world", settings->world, "walk, scan or room")
      ->transform(CLI::CheckedTransformer(std::map<std::string, WorldKind>{
          {"walk", WorldKind::kWalk}, {"scan", WorldKind::kScan}, {"room", WorldKind::kRoom}}));
  command->add_option("--loops", settings->loops, "on or off")->transform(on_off());
  command->add_option("--submaps", settings->submaps, "on or off")->transform(on_off());
  command->add_option("--false-loops", settings->false_loops, "share of loops that are none")
      ->transform(in_range(Range::number(0.0, 0.9)));
  command->add_option("--iterations", settings->iterations, "after each submap and loop")
      ->transform(in_range(Range::whole(1, kMany)));
  command
      ->add_option("--window-submaps", settings->window_submaps,
                   "newest submaps whose keyframes are optimised; 0: the full batch")
      ->transform(in_range(Range::whole(2, 64).or_zero()));
  command
      ->add_option("--skeleton-capacity", settings->skeleton_capacity,
                   "older submaps that are optimised one by one; 0: no limit")
      ->transform(in_range(Range::whole(8, 65536).or_zero()));
  command
      ->add_option("--readable", settings->readable,
                   "newest keyframes that stay readable in a sliding window; 0: all")
      ->transform(in_range(Range::whole(0, 65536)));
  add_ablations(command, settings);
  command->add_option("--batch", settings->batch, "on: walk once more as a full batch, to compare")
      ->transform(on_off());
  command->add_flag("--json", *json, "one line of JSON");
}

void add_depth(CLI::App* app, DepthSettings* settings) {
  CLI::App* command = app->add_subcommand("depth", "Ratios of depth maps, by size");
  command->add_option("--repeat", settings->repeat, "measurements per size, the median is shown")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_flag("--json", settings->json, "one line of JSON");
}

void add_places(CLI::App* app, PlacesSettings* settings) {
  CLI::App* command = app->add_subcommand("places", "A search among the places of many keyframes");
  command->add_option("--keyframes", settings->keyframes, "in the index")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_option("--repeat", settings->repeat, "searches")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_flag("--json", settings->json, "one line of JSON");
}

void add_lanes(CLI::App* app, LanesSettings* settings) {
  CLI::App* command =
      app->add_subcommand("lanes", "The live pose beside windows that take long, and none");
  command->add_option("--keyframes", settings->keyframes, "of one run, 6 a second")
      ->transform(in_range(Range::whole(32, 65536)));
  command->add_option("--repeat", settings->repeat, "pairs of runs, the median ratio is shown")
      ->transform(in_range(Range::whole(1, kMany)));
  command->add_option("--window-s", settings->window_s, "seconds for a window")
      ->transform(in_range(Range::number(0.0, 60.0)));
  command->add_option("--pair-ms", settings->pair_ms, "milliseconds for a pair")
      ->transform(in_range(Range::above(0.0, 100.0)));
  command->add_flag("--busy", settings->busy, "windows are computed on this processor");
  command->add_flag("--json", settings->json, "one line of JSON");
}

int bench(int argc, const char* const* argv) {
  CLI::App app("Times and memory of libunisim; times are CPU time of the process.");
  app.set_version_flag("--version", unisim::replay::version_text());
  app.require_subcommand(1);
  SolverSettings solver;
  add_solver(&app, &solver);
  UpdateSettings updates;
  add_updates(&app, &updates);
  CovarianceSettings covariance;
  add_covariance(&app, &covariance);
  WalkSettings walk;
  bool walk_json = false;
  add_window(&app, &walk, &walk_json);
  DepthSettings depth;
  add_depth(&app, &depth);
  LanesSettings lanes;
  add_lanes(&app, &lanes);
  PlacesSettings places;
  add_places(&app, &places);
  if (!unisim::tools::parse(&app, argc, argv)) return unisim::tools::kExitDone;
  try {
    if (app.got_subcommand("window")) return walk_command(walk, walk_json);
    if (app.got_subcommand("updates")) return update_command(updates);
    if (app.got_subcommand("covariance")) return covariance_command(covariance);
    if (app.got_subcommand("depth")) return depth_command(depth);
    if (app.got_subcommand("lanes")) return lanes_command(lanes);
    if (app.got_subcommand("places")) return places_command(places);
    return solver_command(solver);
  } catch (const unisim::sequence::InputError& error) {
    throw unisim::tools::Failure(unisim::tools::kExitInput, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  return unisim::tools::run_program("unisim-bench", [&] { return bench(argc, argv); });
}
