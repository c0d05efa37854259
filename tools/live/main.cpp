// SPDX-License-Identifier: MIT
// unisim-live: a camera goes in, poses come out.
#include <memory>
#include <optional>
#include <utility>

#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"
#include "tools/common/program.hpp"
#include "tools/live/camera.hpp"
#include "tools/live/frame_recorder.hpp"
#include "tools/live/lcm_images.hpp"
#include "tools/live/lcm_odometry.hpp"
#include "tools/live/options.hpp"
#include "tools/live/played_camera.hpp"
#include "tools/live/pose_age.hpp"
#include "tools/live/scheduling.hpp"
#include "tools/live/status_text.hpp"
#include "tools/live/web/output.hpp"
#include "tools/replay/inputs.hpp"
#include "tools/replay/interrupt.hpp"
#include "tools/replay/run.hpp"

namespace unisim::live {
namespace {

/// Of the frames of a recording that plays a camera.
std::optional<replay::FrameSize> recorded_size(const replay::Options& options) {
  replay::Options recording = options;
  recording.settings.pipeline.live = false;
  return replay::frame_size(recording);
}

/// One run: what listens to it lives as long as it does.
class LiveRun {
 public:
  explicit LiveRun(const Options& options)
      : options_(options), status_(&ages_), web_(options, &ages_) {}

  int go(const std::atomic<bool>& stop) {
    replay::Surroundings around;
    around.open = [this] { return open(); };
    around.line = [this](const pipeline::Progress& progress) { return status_(progress); };
    around.starts = [this](const pipeline::Pipeline& pipeline, unisim_predictor* predictor) {
      web_.attach(pipeline, predictor);
    };
    around.ended = [this](const unisim_source* source) { end(source); };
    if (!options_.odometry_channel.empty()) around.odometry = &inbox_;
    const int code = replay::run(options_.run, around, stop);
    return code == tools::kExitDone && recording_failed_ ? tools::kExitLimit : code;
  }

 private:
  replay::Input open() {
    replay::Input input;
    if (is_camera(options_.device)) {
      int64_t offset_ns = 0;
      input = open_camera(options_, &offset_ns);
      ages_.set_stamp_clock(offset_ns);
    } else if (is_lcm(options_.device)) {
      input = open_lcm_images(options_);
    } else {
      input.source = replay::open_sequence(options_.run, &input.notes);
      if (options_.as_camera) {
        input.live_size = recorded_size(options_.run);
        const int64_t offset_ns = time_of_day_offset_ns();
        input.source = play_as_camera(std::move(input.source), offset_ns);
        ages_.set_stamp_clock(offset_ns);
      }
    }
    if (!options_.odometry_channel.empty()) odometry_ = open_odometry(options_, &inbox_);
    input.listeners.push_back(&ages_);
    if (web_.listener() != nullptr) input.listeners.push_back(web_.listener());
    input.notes.push_back(web_.note());
    if (!options_.run.out.empty() && options_.record_images) {
      recorder_.emplace(options_.run.out + "/recording", options_.run.force);
      input.listeners.push_back(&*recorder_);
    }
    return input;
  }

  void end(const unisim_source* source) {
    std::string losses;
    if (is_camera(options_.device)) losses = camera_losses(source);
    if (is_lcm(options_.device)) losses = lcm_losses(source);
    if (!losses.empty()) tools::complain(kProgramName, "frames " + losses);
    losses = odometry_ ? odometry_losses(options_, odometry_->counts()) : "";
    if (!losses.empty()) tools::complain(kProgramName, losses);
    if (ages_.known() && !options_.run.quiet) tools::complain(kProgramName, age_text(ages_.ages()));
    if (!recorder_) return;
    const std::string problem = recorder_->finish();
    recording_failed_ = !problem.empty();
    if (recording_failed_) tools::complain(kProgramName, problem);
  }

  const Options& options_;
  PoseAge ages_;
  StatusText status_;
  web::Output web_;
  pipeline::DistanceInbox inbox_;
  std::unique_ptr<lcm::OdometryListener> odometry_;  // NULL: none over LCM
  std::optional<FrameRecorder> recorder_;
  bool recording_failed_ = false;
};

int run(int argc, const char* const* argv) {
  const std::atomic<bool>& stop = replay::catch_interrupts();
  const auto options = parse_options(argc, argv);
  if (!options) return tools::kExitDone;
  if (options->run.print_config) {
    tools::print(replay::settings_text(options->run.settings));
    return tools::kExitDone;
  }
  if (options->list) {
    tools::print(camera_table());
    return tools::kExitDone;
  }
  apply(options->scheduling);
  return LiveRun(*options).go(stop);
}

}  // namespace
}  // namespace unisim::live

int main(int argc, char** argv) {
  return unisim::tools::run_program(unisim::live::kProgramName,
                                    [&] { return unisim::live::run(argc, argv); });
}
