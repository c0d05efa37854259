// SPDX-License-Identifier: MIT
// The command line of unisim-replay.
#include "tools/replay/options.hpp"

#include <CLI/CLI.hpp>

#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/run_options.hpp"
#include "tools/replay/version.hpp"

namespace unisim::replay {
namespace {

using tools::in_range;
using tools::Range;

// Three years of video.
constexpr int64_t kMostFrames = 10000000000;

void add_input_options(CLI::App* app, Options* options, bool* realtime) {
  app->add_option("sequence", options->sequence, "folder, image glob, video file or LCM event log");
  app->add_option("--format", options->format,
                  "auto, tum, 7scenes, euroc, kitti, replica, images, video or lcm")
      ->check(CLI::IsMember(
          {"auto", "tum", "7scenes", "euroc", "kitti", "replica", "images", "video", "lcm"}));
  app->add_option("--from", options->from, "first frame")
      ->transform(in_range(Range::whole(0, kMostFrames)));
  app->add_option("--to", options->to, "frame after the last one")
      ->transform(in_range(Range::whole(0, kMostFrames)));
  app->add_option("--ground-truth", options->ground_truth,
                  "poses in TUM format (default: what the sequence carries)");
  app->add_flag("--list-frames", options->list_frames,
                "print the frames as JSON lines (--format, --from, --to, --stride), end");
  app->add_flag("--realtime", *realtime, "keep to the recorded times, drop late frames");
  app->add_option("--lcm-image-channel", options->lcm_image_channel,
                  "channel of an LCM event log to read (default: UNISIM_IMAGE, or the only one)");
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
  require(!options.lcm || !options.list_frames, "--lcm goes with a run, not with --list-frames");
}

}  // namespace

std::optional<Options> parse_options(int argc, const char* const* argv) {
  CLI::App app("Replays a recorded sequence: images in, trajectory, map and report out.",
               kProgramName);
  app.set_version_flag("--version", version_text());
  Options options;
  bool realtime = false;
  add_input_options(&app, &options, &realtime);
  RunOptions run_options(&app, &options);
  if (!tools::parse(&app, argc, argv)) return std::nullopt;
  run_options.apply();
  if (realtime) options.settings.pipeline.realtime = true;
  if (!options.print_config) {
    check(options);
    run_options.check();
  }
  return options;
}

}  // namespace unisim::replay
