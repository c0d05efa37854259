// SPDX-License-Identifier: MIT
// The part of the command line that every program that runs has.
#include "tools/replay/run_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "drivers/lcm/problem.h"
#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/settings_fields.hpp"
#include "tools/replay/window_layout.hpp"

namespace unisim::replay {
namespace {

using tools::in_range;
using tools::Range;

// 12 MB a submap.
constexpr int64_t kMostPoints = 1000000;
// An odometer that is surer than this is not known, and one less sure says nothing.
constexpr double kLeastOdometrySigma = 1e-4;
constexpr double kMostOdometrySigma = 0.3;
// From a toy to a crane.
constexpr double kLeastCameraHeight = 0.01;
constexpr double kMostCameraHeight = 100.0;

const std::map<std::string, uint32_t> kFactors = {
    {"e2v", UNISIM_FACTOR_TWO_VIEW},
    {"anchor", UNISIM_FACTOR_SCALE_ANCHOR},
    {"bridge", UNISIM_FACTOR_BRIDGE},
    {"tie", UNISIM_FACTOR_TIE},
    {"scale", UNISIM_FACTOR_SCALE},
    {"v2s", UNISIM_FACTOR_BRIDGE | UNISIM_FACTOR_SCALE_ANCHOR},
    {"s2s", UNISIM_FACTOR_TIE | UNISIM_FACTOR_SCALE}};

}  // namespace

RunOptions::RunOptions(CLI::App* app, Options* options) : options_(options) {
  options_->settings = default_settings();
  add_camera_options(app);
  add_method_options(app);
  add_map_options(app);
  add_scale_options(app);
  add_model_options(app);
  add_output_options(app);
  add_lcm_options(app);
}

void RunOptions::add_camera_options(CLI::App* app) {
  app->add_option("--mask", options_->mask,
                  "image of the frames' size, black where nothing is to be looked at (own body)");
  app->add_option("--focal", focal_, "known focal length in pixels (default: estimated)")
      ->transform(in_range(Range::above(0.0, kMostFocalPx)));
  app->add_option("--principal", principal_,
                  "known principal point, X,Y in pixels (default: the middle)")
      ->delimiter(',')
      ->expected(2)
      ->transform(in_range(Range::above(0.0, kMostFocalPx)));
  app->add_option(
         "--distortion", distortion_,
         "known distortion, OpenCV's k1,k2[,p1,p2[,k3]], with --focal (default: estimated)")
      ->delimiter(',')
      ->expected(2, 5)
      ->transform(in_range(Range::number(-kMostDistortion, kMostDistortion)));
  app->add_option("--calibration", calibration_,
                  "the three from a YAML file as OpenCV, ROS or EuRoC write it");
  app->add_flag("--rolling-shutter", rolling_,
                "rows are read one after the other; how fast is estimated");
  app->add_option("--readout-ms", readout_ms_,
                  "known time from the first row of an image to the last, negative from below")
      ->transform(in_range(Range::number(-kMostReadoutMs, kMostReadoutMs)));
}

void RunOptions::add_scale_options(CLI::App* app) {
  const char* const group = "Metric scale";
  app->add_option("--odometry", options_->odometry,
                  "what an odometer said, lines \"time path\", \"time x y [z]\" or TUM poses in "
                  "seconds and metres: results are in metres; with unisim-live lcm:CHANNEL")
      ->group(group);
  app->add_option("--odometry-sigma", options_->odometry_sigma,
                  "its standard deviation over the path")
      ->capture_default_str()
      ->transform(in_range(Range::number(kLeastOdometrySigma, kMostOdometrySigma)))
      ->group(group);
  app->add_option("--odometry-common", options_->odometry_common,
                  "relative error that all of it shares (default: 0; of a path alone 0.05)")
      ->transform(in_range(Range::number(0.0, 1.0)))
      ->group(group);
  app->add_option("--camera-height", options_->settings.pipeline.camera_height,
                  "of the camera over the ground it drives on, metres: results are in metres")
      ->transform(in_range(Range::number(kLeastCameraHeight, kMostCameraHeight)))
      ->group(group);
}

void RunOptions::add_method_options(CLI::App* app) {
  app->add_option("--predictor", options_->predictor, "geometric, onnx or recorded")
      ->check(CLI::IsMember({"geometric", "recorded", "onnx"}));
  app->add_option(
      "--predictions", options_->predictions,
      "file written by --record; of the images only the colours are taken, they may be missing");
  app->add_option("--record", options_->record, "store every prediction in this file");
  app->add_option("--stride", stride_, "every N-th frame is a keyframe (default: by motion)")
      ->transform(in_range(Range::whole(1, kMostStride)));
  app->add_flag("--every-frame", every_frame_, "also pose the frames between keyframes");
  app->add_option("--window", window_, "keyframes of a submap (default: 16)")
      ->transform(in_range(Range::whole(2, UNISIM_MAX_VIEWS)));
  app->add_option("--overlap", overlap_,
                  "keyframes shared by neighbouring submaps (default: 8; of networks 2)")
      ->transform(in_range(Range::whole(0, UNISIM_MAX_VIEWS - 1)));
  app->add_flag("--batch", batch_,
                "keep the whole map within a declared number of keyframes (default: the newest 24 "
                "submaps and a skeleton of the older ones, in the same memory for ever)");
  app->add_option("--config", config_, "TOML file, see --print-config");
  app->add_flag("--print-config", options_->print_config, "print the effective configuration, end");
  app->add_flag("--no-loop", no_loop_, "close no loops");
  app->add_option("--disable", disabled_,
                  "leave a factor out: e2v anchor bridge tie scale, "
                  "or a group: v2s s2s")
      ->delimiter(',')
      ->check(CLI::IsMember(kFactors));
}

void RunOptions::add_map_options(CLI::App* app) {
  const char* const group = "Maps that outlive the run";
  app->add_option("--save-map", options_->save_map, "write the map of the run to this file")
      ->group(group);
  app->add_option("--load-map", options_->load_map, "go on in the map of an earlier run")
      ->group(group);
  app->add_flag("--localise", options_->localise,
                "only look for frames in the map of --load-map, which stays as it is")
      ->group(group);
}

void RunOptions::add_model_options(CLI::App* app) {
  const char* const group = "--predictor onnx";
  app->add_option("--model", model_, "ONNX file for pairs and windows")->group(group);
  app->add_option("--model-2v", options_->model_pair, "ONNX file for pairs")->group(group);
  app->add_option("--model-mv", options_->model_window, "ONNX file for windows")->group(group);
  app->add_option("--model-encoder", options_->model_encoder,
                  "encoder of split models (default: X.encoder.onnx beside X.onnx)")
      ->group(group);
  app->add_option("--model-descriptor", options_->model_descriptor,
                  "ONNX file that tells places apart, for loops (default: without a network)")
      ->group(group);
  app->add_option("--provider", options_->provider, "cpu, cuda, tensorrt or what the library has")
      ->capture_default_str()
      ->group(group);
  app->add_option("--threads", threads_, "of one inference (default: one per core)")
      ->transform(in_range(Range::whole(1, kMostThreads)))
      ->group(group);
  app->add_option("--model-memory", memory_mb_,
                  "MB one inference and kept keyframes may take (default: half of the machine's)")
      ->transform(in_range(Range::whole(1, kMostMemoryMb)))
      ->group(group);
  app->add_option("--onnx-runtime", options_->onnx_runtime,
                  "libonnxruntime to open (default: UNISIM_ORT_LIB, bootstrap's, the system's)")
      ->group(group);
}

void RunOptions::add_output_options(CLI::App* app) {
  app->add_option("--out", options_->out, "folder for the results, made if absent");
  app->add_flag("--force", options_->force, "overwrite earlier results");
  app->add_flag("--report,!--no-report", options_->report, "write report.html (default)");
  app->add_flag("--quiet", options_->quiet, "no progress");
  app->add_flag("--json", options_->json, "progress and result as JSON lines on stdout");
}

void RunOptions::add_lcm_options(CLI::App* app) {
  const char* const group = "LCM (drivers/lcm/README.md)";
  app->add_option("--lcm", options_->lcm,
                  "also publish on this URL, such as " UNISIM_LCM_DEFAULT_URL)
      ->group(group);
  app->add_flag("--lcm-images", options_->lcm_images, "publish the frames too")->group(group);
  app->add_option("--lcm-points", options_->lcm_points, "publish so many points of each submap too")
      ->transform(in_range(Range::whole(0, kMostPoints)))
      ->group(group);
}

void RunOptions::apply() {
  Settings* const settings = &options_->settings;
  if (!config_.empty()) load_settings(config_, settings);
  if (stride_) settings->pipeline.keyframes.stride = *stride_;
  if (window_) {
    settings->session.window_size = *window_;
    settings->window_size_given = true;
  }
  if (overlap_) {
    settings->session.window_overlap = *overlap_;
    settings->window_overlap_given = true;
  }
  take_camera();
  if (batch_) settings->session.window_submaps = 0;
  if (every_frame_) settings->pipeline.every_frame = true;
  if (threads_) settings->onnx.threads = *threads_;
  if (memory_mb_) settings->onnx.memory_mb = *memory_mb_;
  if (no_loop_) {
    settings->geometric.loop_tries = 0;
    settings->pipeline.loops.places = 0;
  }
  for (const std::string& name : disabled_) {
    settings->session.disabled_factors |= kFactors.at(name);
  }
  take_models();
  set_default_overlap(options_->predictor, settings);
}

/// --model serves where the role has no model of its own.
void RunOptions::take_models() {
  if (options_->model_pair.empty()) options_->model_pair = model_;
  if (options_->model_window.empty()) options_->model_window = model_;
}

void RunOptions::take_camera() {
  unisim_geometric_config* const camera = &options_->settings.geometric;
  const auto require = [](bool good, const char* line) {
    if (!good) throw tools::Failure(tools::kExitUsage, line);
  };
  const bool apart = !principal_.empty() || !distortion_.empty();
  const bool rolling = rolling_ || readout_ms_;
  require(calibration_.empty() || (!focal_ && !apart),
          "--calibration says it all; leave out --focal, --principal and --distortion");
  require(options_->predictor == "geometric" || (calibration_.empty() && !apart),
          "--principal, --distortion and --calibration go with --predictor geometric");
  require(options_->predictor == "geometric" || !rolling,
          "--rolling-shutter and --readout-ms go with --predictor geometric");
  require(!readout_ms_ || *readout_ms_ != 0, "--readout-ms 0 is no rolling shutter: leave it out");
  if (rolling) camera->shutter = UNISIM_SHUTTER_ROLLING;
  if (readout_ms_) camera->readout_ms = *readout_ms_;
  require(distortion_.size() != 3, "--distortion takes k1,k2 or k1,k2,p1,p2 or k1,k2,p1,p2,k3");
  if (focal_) {
    camera->focal_px = *focal_;
    camera->focal_y_px = 0;
  }
  if (!principal_.empty()) {
    camera->principal_x_px = principal_[0];
    camera->principal_y_px = principal_[1];
  }
  if (!distortion_.empty()) {
    require(camera->focal_px > 0, "--distortion needs --focal: it is told in focal lengths");
    camera->distortion_model = UNISIM_DISTORTION_PINHOLE;
    std::fill(camera->distortion, camera->distortion + UNISIM_DISTORTION_TERMS, 0.0);
    std::copy(distortion_.begin(), distortion_.end(), camera->distortion);
  }
  if (calibration_.empty()) return;
  char message[1024] = "";
  if (unisim_geometric_read_calibration(calibration_.c_str(), camera, message, sizeof message) ==
      0) {
    throw tools::Failure(tools::kExitInput, message);
  }
}

void RunOptions::check_maps() const {
  const Options& options = *options_;
  const auto require = [](bool good, const std::string& line) {
    if (!good) throw tools::Failure(tools::kExitUsage, line);
  };
  const char* const kept =
      ": maps are kept by the geometric predictor; leave it away or use --predictor geometric";
  const bool keeps = options.predictor == "geometric";
  require(keeps || options.save_map.empty(), std::string("--save-map") + kept);
  require(keeps || options.load_map.empty(), std::string("--load-map") + kept);
  require(!options.localise || !options.load_map.empty(), "--localise needs --load-map FILE");
  require(!options.localise || options.save_map.empty(),
          "--localise leaves the map as it is: there is nothing for --save-map");
  require(options.load_map.empty() || options.record.empty(),
          "--record stores a run from its beginning: it does not go with --load-map");
  require(options.load_map.empty() || options.settings.geometric.places != 0,
          "--load-map needs places: a frame is found in a map by them");
}

void RunOptions::check() const {
  check_maps();
  const Options& options = *options_;
  const auto require = [](bool good, const char* line) {
    if (!good) throw tools::Failure(tools::kExitUsage, line);
  };
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
                   options.model_encoder.empty() && options.model_descriptor.empty()),
          "--model, --model-2v, --model-mv, --model-encoder and --model-descriptor go with "
          "--predictor onnx");
  require(options.lcm || (!options.lcm_images && options.lcm_points == 0),
          "--lcm-images and --lcm-points go with --lcm URL");
  check_together(options.settings);
}

}  // namespace unisim::replay
