// SPDX-License-Identifier: MIT
// The command line of unisim-live.
#include "tools/live/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/run_options.hpp"
#include "tools/replay/version.hpp"

namespace unisim::live {
namespace {

using tools::in_range;
using tools::Range;

/// What the command line says in words.
struct Given {
  std::string size;
  std::string exposure;
  std::string focus;
  std::string power_line;
};

tools::Failure wrong(const std::string& option, const std::string& value, const char* must) {
  return {tools::kExitUsage, option + " is \"" + value + "\", must be " + must};
}

/// A whole number and nothing else.
std::optional<int32_t> whole(const std::string& text) {
  if (text.empty() || text.size() > 9) return std::nullopt;
  const bool digits =
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= '0' && c <= '9'; });
  return digits ? std::optional<int32_t>(std::stoi(text)) : std::nullopt;
}

void take_size(const std::string& text, unisim_v4l2_config* camera) {
  const size_t cross = text.find('x');
  const auto width = whole(text.substr(0, cross));
  const auto height = cross == std::string::npos ? std::nullopt : whole(text.substr(cross + 1));
  if (!width || !height || *width < 1 || *height < 1) {
    throw wrong("--size", text, "WIDTHxHEIGHT, such as 640x480");
  }
  camera->width = *width;
  camera->height = *height;
}

/// "keep", "auto", "fixed" or a number.
void take_control(const std::string& option, const std::string& text, int32_t* mode,
                  int32_t* value) {
  const auto number = whole(text);
  if (text == "keep") {
    *mode = UNISIM_V4L2_KEEP;
  } else if (text == "auto") {
    *mode = UNISIM_V4L2_AUTO;
  } else if (text == "fixed" || number) {
    *mode = UNISIM_V4L2_FIXED;
    if (number) *value = *number;
  } else {
    throw wrong(option, text, "auto, fixed, keep or a number");
  }
}

void take_power_line(const std::string& text, unisim_v4l2_config* camera) {
  if (text == "keep") return;
  if (text == "off") {
    camera->power_line_hz = -1;
  } else if (text == "50" || text == "60") {
    camera->power_line_hz = std::stoi(text);
  } else {
    throw wrong("--power-line", text, "50, 60, off or keep");
  }
}

void add_camera_options(CLI::App* app, Options* options, Given* given) {
  app->add_option(
      "--device", options->device,
      "camera: /dev/videoN, N or its bus name (default: the first one); lcm:// or "
      "lcm://ADDRESS:PORT: images that come over LCM; or a recorded sequence to play at "
      "its own pace");
  app->add_flag("--list", options->list, "print the cameras and what they offer, end");
  const char* const group = "Camera";
  app->add_option("--size", given->size, "WIDTHxHEIGHT (default: 640x480)")->group(group);
  app->add_option("--fps", options->camera.fps, "frames per second (default: 30)")
      ->transform(in_range(Range::whole(1, 1000)))
      ->group(group);
  app->add_option("--pixel-format", options->pixel_format,
                  "GREY, YUYV, NV12, MJPG or auto: one that is not compressed, if it is as fast")
      ->check(CLI::IsMember({"auto", "GREY", "YUYV", "NV12", "MJPG"}, CLI::ignore_case))
      ->capture_default_str()
      ->group(group);
  app->add_option("--exposure", given->exposure,
                  "auto, fixed (as it is now), microseconds, or keep (default)")
      ->group(group);
  app->add_option("--focus", given->focus,
                  "auto, fixed (as it is now), a position in the camera's unit, or keep (default)")
      ->group(group);
  app->add_option("--power-line", given->power_line,
                  "50, 60 or off: against the flicker of lamps; or keep (default)")
      ->group(group);
  app->add_option("--lcm-image-channel", options->image_channel,
                  "channel of the images with --device lcm:// (default: UNISIM_IMAGE)")
      ->group(group);
  app->add_option("--format", options->run.format,
                  "of a recorded sequence, as unisim-replay has it")
      ->group(group);
  app->add_flag("--as-camera", options->as_camera,
                "the recorded sequence plays a camera: its frames are stamped with the time of day "
                "and wait for nothing")
      ->group(group);
}

void add_process_options(CLI::App* app, Options* options) {
  app->add_flag("--record-images,!--no-record-images", options->record_images,
                "with --out: keep the images in DIR/recording, to replay the run (default)");
  CLI::Option* const web = app->add_option(
      "--web", options->web,
      "show the run on a page at this PORT of this machine, 0: any that is free; or at "
      "ADDRESS:PORT, such as 0.0.0.0:8080, for others too");
  web->type_name("[ADDRESS:]PORT");
  app->add_option("--web-token", options->web_token,
                  "secret that the page asks for, as ?token=...; or in UNISIM_WEB_TOKEN, where "
                  "other users do not see it")
      ->envname("UNISIM_WEB_TOKEN")
      ->needs(web);
  const char* const group = "Process";
  app->add_option("--priority", options->scheduling.priority,
                  "real-time priority, 1 to 99 (default: the usual sharing)")
      ->transform(in_range(Range::whole(1, 99)))
      ->group(group);
  app->add_option("--cpus", options->scheduling.cpus, "run on these processors only, such as 2,3")
      ->delimiter(',')
      ->transform(in_range(Range::whole(0, kMostCpus - 1)))
      ->group(group);
  app->add_flag("--lock-memory", options->scheduling.lock_memory, "let nothing be swapped out")
      ->group(group);
}

/// "lcm:CHANNEL"; a file only goes with a recording that keeps its own stamps.
void take_odometry(Options* options) {
  std::string& given = options->run.odometry;
  constexpr const char* kScheme = "lcm:";
  const bool recorded = !is_camera(options->device) && !is_lcm(options->device);
  if (given.rfind(kScheme, 0) == 0) {
    options->odometry_channel = given.substr(std::string(kScheme).size());
    given.clear();
    if (options->odometry_channel.empty() || options->odometry_channel == "UNISIM_POSE") {
      throw tools::Failure(tools::kExitUsage,
                           "--odometry lcm:CHANNEL: give the channel of the odometer's poses, such "
                           "as lcm:ODOMETRY; UNISIM_POSE has those of this program");
    }
  } else if (!given.empty() && (!recorded || options->as_camera)) {
    throw tools::Failure(tools::kExitUsage,
                         "--odometry " + given +
                             ": a file is of a run that has been; give lcm:CHANNEL, poses of an "
                             "odometer that come over LCM");
  }
}

void take(const Given& given, Options* options) {
  unisim_v4l2_config* const camera = &options->camera;
  if (!given.size.empty()) take_size(given.size, camera);
  if (!given.exposure.empty()) {
    take_control("--exposure", given.exposure, &camera->exposure, &camera->exposure_us);
  }
  if (!given.focus.empty()) {
    take_control("--focus", given.focus, &camera->focus, &camera->focus_position);
  }
  if (!given.power_line.empty()) take_power_line(given.power_line, camera);
}

}  // namespace

bool is_camera(const std::string& device) {
  return device.empty() || device.rfind("/dev/", 0) == 0 || whole(device).has_value() ||
         device.rfind("usb-", 0) == 0 || device.rfind("platform:", 0) == 0;
}

bool is_lcm(const std::string& device) { return device.rfind(kLcmScheme, 0) == 0; }

std::optional<Options> parse_options(int argc, const char* const* argv) {
  CLI::App app("A camera goes in, poses come out.", kProgramName);
  app.set_version_flag("--version", replay::version_text());
  Options options;
  options.run.program = kProgramName;
  unisim_v4l2_config_init(&options.camera, sizeof options.camera);
  Given given;
  add_camera_options(&app, &options, &given);
  replay::RunOptions run_options(&app, &options.run);
  add_process_options(&app, &options);
  if (!tools::parse(&app, argc, argv)) return std::nullopt;
  take(given, &options);
  run_options.apply();
  options.run.settings.pipeline.every_frame = true;
  if (!is_lcm(options.device) && !options.image_channel.empty()) {
    throw tools::Failure(tools::kExitUsage, "--lcm-image-channel goes with --device lcm://");
  }
  if (is_lcm(options.device) && options.run.lcm_images) {
    throw tools::Failure(
        tools::kExitUsage,
        "--lcm-images with --device lcm://: it would hear its own images; they are "
        "on the network already");
  }
  const bool recorded = !is_camera(options.device) && !is_lcm(options.device);
  if (options.as_camera && !recorded) {
    throw tools::Failure(tools::kExitUsage,
                         "--as-camera goes with a recorded sequence as --device");
  }
  if (!recorded) {
    options.run.settings.pipeline.live = true;
    options.run.sequence = options.device.empty() ? "camera" : options.device;
  } else {
    (options.as_camera ? options.run.settings.pipeline.live
                       : options.run.settings.pipeline.realtime) = true;
    options.run.sequence = options.device;
  }
  if (options.run.predictor == "recorded") {
    throw tools::Failure(tools::kExitUsage,
                         "--predictor recorded: what a camera sees has not been recorded; use "
                         "geometric or onnx");
  }
  take_odometry(&options);
  if (!options.run.print_config && !options.list) run_options.check();
  return options;
}

}  // namespace unisim::live
