// SPDX-License-Identifier: MIT
// The command line of unisim-replay.
#include "tools/replay/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <vector>

#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/settings_fields.hpp"
#include "tools/replay/version.hpp"
#include "tools/replay/window_layout.hpp"

namespace unisim::replay {
namespace {

using tools::in_range;
using tools::Range;

// Three years of video.
constexpr int64_t kMostFrames = 10000000000;

const std::map<std::string, uint32_t> kFactors = {
    {"e2v", UNISIM_FACTOR_TWO_VIEW},
    {"anchor", UNISIM_FACTOR_SCALE_ANCHOR},
    {"bridge", UNISIM_FACTOR_BRIDGE},
    {"tie", UNISIM_FACTOR_TIE},
    {"scale", UNISIM_FACTOR_SCALE},
    {"v2s", UNISIM_FACTOR_BRIDGE | UNISIM_FACTOR_SCALE_ANCHOR},
    {"s2s", UNISIM_FACTOR_TIE | UNISIM_FACTOR_SCALE}};

/// What the command line says, before it meets the configuration file.
struct Given {
  std::string config;
  std::optional<int32_t> stride;
  std::optional<int32_t> window;
  std::optional<int32_t> overlap;
  std::optional<double> focal;
  std::vector<std::string> disabled;
  bool every_frame = false;
  bool batch = false;
  bool realtime = false;
  std::string model;
  std::optional<int32_t> threads;
  std::optional<int32_t> memory_mb;
  std::string lcm;
};

void add_input_options(CLI::App* app, Options* options, Given* given) {
  app->add_option("sequence", options->sequence, "folder, image glob or video file");
  app->add_option("--format", options->format,
                  "auto, tum, 7scenes, euroc, kitti, replica, images or video")
      ->check(CLI::IsMember(
          {"auto", "tum", "7scenes", "euroc", "kitti", "replica", "images", "video", "lcm"}));
  app->add_option("--from", options->from, "first frame")
      ->transform(in_range(Range::whole(0, kMostFrames)));
  app->add_option("--to", options->to, "frame after the last one")
      ->transform(in_range(Range::whole(0, kMostFrames)));
  app->add_option("--mask", options->mask,
                  "image of the frames' size, black where nothing is to be looked at (own body)");
  app->add_option("--focal", given->focal, "known focal length in pixels (default: estimated)")
      ->transform(in_range(Range::above(0.0, kMostFocalPx)));
  app->add_option("--ground-truth", options->ground_truth,
                  "poses in TUM format (default: what the sequence carries)");
  app->add_flag("--list-frames", options->list_frames,
                "print the frames as JSON lines (--format, --from, --to, --stride), end");
  app->add_flag("--realtime", given->realtime, "keep to the recorded times, drop late frames");
}

void add_method_options(CLI::App* app, Options* options, Given* given) {
  app->add_option("--predictor", options->predictor, "geometric, onnx or recorded")
      ->check(CLI::IsMember({"geometric", "recorded", "onnx"}));
  app->add_option("--predictions", options->predictions, "file written by --record");
  app->add_option("--record", options->record, "store every prediction in this file");
  app->add_option("--stride", given->stride, "every N-th frame is a keyframe (default: by motion)")
      ->transform(in_range(Range::whole(1, kMostStride)));
  app->add_flag("--every-frame", given->every_frame, "also pose the frames between keyframes");
  app->add_option("--window", given->window, "keyframes of a submap (default: 16)")
      ->transform(in_range(Range::whole(2, UNISIM_MAX_VIEWS)));
  app->add_option("--overlap", given->overlap,
                  "keyframes shared by neighbouring submaps (default: 8; of networks 2)")
      ->transform(in_range(Range::whole(0, UNISIM_MAX_VIEWS - 1)));
  app->add_flag("--batch", given->batch,
                "keep the whole map within a declared number of keyframes (default: the newest 24 "
                "submaps and a skeleton of the older ones, in the same memory for ever)");
  app->add_option("--config", given->config, "TOML file, see --print-config");
  app->add_flag("--print-config", options->print_config, "print the effective configuration, end");
  app->add_flag("--no-loop", "close no loops; no effect yet: none are closed");
  app->add_option("--disable", given->disabled,
                  "leave a factor out: e2v anchor bridge tie scale, "
                  "or a group: v2s s2s")
      ->delimiter(',')
      ->check(CLI::IsMember(kFactors));
  app->add_option("--lcm", given->lcm)->group("");
}

void add_model_options(CLI::App* app, Options* options, Given* given) {
  const char* const group = "--predictor onnx";
  app->add_option("--model", given->model, "ONNX file for pairs and windows")->group(group);
  app->add_option("--model-2v", options->model_pair, "ONNX file for pairs")->group(group);
  app->add_option("--model-mv", options->model_window, "ONNX file for windows")->group(group);
  app->add_option("--model-encoder", options->model_encoder,
                  "encoder of split models (default: X.encoder.onnx beside X.onnx)")
      ->group(group);
  app->add_option("--provider", options->provider, "cpu, cuda, tensorrt or what the library has")
      ->capture_default_str()
      ->group(group);
  app->add_option("--threads", given->threads, "of one inference (default: one per core)")
      ->transform(in_range(Range::whole(1, kMostThreads)))
      ->group(group);
  app->add_option("--model-memory", given->memory_mb,
                  "MB one inference and kept keyframes may take (default: half of the machine's)")
      ->transform(in_range(Range::whole(1, kMostMemoryMb)))
      ->group(group);
  app->add_option("--onnx-runtime", options->onnx_runtime,
                  "libonnxruntime to open (default: UNISIM_ORT_LIB, bootstrap's, the system's)")
      ->group(group);
}

void add_output_options(CLI::App* app, Options* options) {
  app->add_option("--out", options->out, "folder for the results, made if absent");
  app->add_flag("--force", options->force, "overwrite earlier results");
  app->add_flag("--report,!--no-report", options->report, "write report.html (default)");
  app->add_flag("--quiet", options->quiet, "no progress");
  app->add_flag("--json", options->json, "progress and result as JSON lines on stdout");
}

void refuse_not_built(const Options& options, const Given& given) {
  const auto refuse = [](bool asked, const char* what) {
    if (asked) throw tools::Failure(tools::kExitUsage, std::string(what) + ": not built yet");
  };
  refuse(!given.lcm.empty(), "--lcm");
  refuse(options.format == "lcm", "--format lcm");
}

void apply(const Given& given, Settings* settings) {
  if (given.stride) settings->pipeline.keyframes.stride = *given.stride;
  if (given.window) {
    settings->session.window_size = *given.window;
    settings->window_size_given = true;
  }
  if (given.overlap) {
    settings->session.window_overlap = *given.overlap;
    settings->window_overlap_given = true;
  }
  if (given.focal) settings->geometric.focal_px = *given.focal;
  if (given.batch) settings->session.window_submaps = 0;
  if (given.every_frame) settings->pipeline.every_frame = true;
  if (given.threads) settings->onnx.threads = *given.threads;
  if (given.memory_mb) settings->onnx.memory_mb = *given.memory_mb;
  if (given.realtime) settings->pipeline.realtime = true;
  for (const std::string& name : given.disabled) {
    settings->session.disabled_factors |= kFactors.at(name);
  }
}

/// --model serves where the role has no model of its own.
void take_models(const Given& given, Options* options) {
  if (options->model_pair.empty()) options->model_pair = given.model;
  if (options->model_window.empty()) options->model_window = given.model;
}

void check(const Options& options) {
  const auto require = [](bool good, const char* line) {
    if (!good) throw tools::Failure(tools::kExitUsage, line);
  };
  require(!options.sequence.empty(), "SEQUENCE is missing: give a folder, a glob or a video file");
  require(options.list_frames || !options.out.empty(),
          "--out is missing: give a folder for the results");
  require(!options.list_frames || options.out.empty(),
          "--list-frames prints and writes no results: leave --out away");
  require(options.to < 0 || options.to > options.from, "--to must be greater than --from");
  require(options.predictor != "recorded" || !options.predictions.empty(),
          "--predictor recorded needs --predictions FILE");
  require(options.predictions.empty() || options.predictor == "recorded",
          "--predictions goes with --predictor recorded");
  require(options.mask.empty() || options.predictor == "geometric",
          "--mask goes with --predictor geometric");
  const bool onnx = options.predictor == "onnx";
  require(!onnx || (!options.model_pair.empty() && !options.model_window.empty()),
          "--predictor onnx needs --model FILE, or --model-2v FILE and --model-mv FILE");
  require(onnx || (options.model_pair.empty() && options.model_window.empty() &&
                   options.model_encoder.empty()),
          "--model, --model-2v, --model-mv and --model-encoder go with --predictor onnx");
  check_together(options.settings);
}

}  // namespace

std::optional<Options> parse_options(int argc, const char* const* argv) {
  CLI::App app("Replays a recorded sequence: images in, trajectory, map and report out.",
               kProgramName);
  app.set_version_flag("--version", version_text());
  Options options;
  Given given;
  options.settings = default_settings();
  add_input_options(&app, &options, &given);
  add_method_options(&app, &options, &given);
  add_model_options(&app, &options, &given);
  add_output_options(&app, &options);
  if (!tools::parse(&app, argc, argv)) return std::nullopt;
  refuse_not_built(options, given);
  if (!given.config.empty()) load_settings(given.config, &options.settings);
  apply(given, &options.settings);
  take_models(given, &options);
  set_default_overlap(options.predictor, &options.settings);
  if (!options.print_config) check(options);
  return options;
}

}  // namespace unisim::replay
