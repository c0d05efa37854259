// SPDX-License-Identifier: MIT
// The driver under a real kernel: runs as root in an emulated machine whose only camera is the
// module vivid, and lets that fail in all ways it can. Prints a line for every check.
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>

#include "drivers/v4l2/v4l2.h"
#include "tests/v4l2/vivid/pose_ages.hpp"

namespace {

int failures = 0;

void check(bool fine, const char* what, const std::string& details = "") {
  failures += fine ? 0 : 1;
  std::printf("\nRESULT %s %s%s%s\n", fine ? "ok" : "FAILED", what, details.empty() ? "" : ": ",
              details.c_str());
}

/// Sets one of vivid's controls through a descriptor of its own. @return false: it has none such
bool set_control(const char* device, const char* name, int32_t value) {
  const int fd = open(device, O_RDWR | O_CLOEXEC);
  if (fd < 0) return false;
  v4l2_query_ext_ctrl entry{};
  entry.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  bool found = false;
  while (!found && ioctl(fd, VIDIOC_QUERY_EXT_CTRL, &entry) == 0) {
    found = std::strcmp(entry.name, name) == 0;
    if (!found) entry.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  v4l2_control control{entry.id, value};
  const bool set = found && ioctl(fd, VIDIOC_S_CTRL, &control) == 0;
  close(fd);
  return set;
}

struct Run {
  explicit Run(unisim_v4l2_config config) {
    char text[512] = "";
    source = unisim_v4l2_open(&config, &problem, text, sizeof text);
    message = text;
  }
  ~Run() {
    if (source != nullptr) source->destroy(source);
  }
  int next() {
    const int status = source->next_frame(source, 1, &frame);
    if (status != UNISIM_FRAME_OK) message = source->message(source);
    return status;
  }
  /// Frames until so many are good. @return lines of the others
  std::string read(int count) {
    std::string lines;
    for (int good = 0, answers = 0; good < count && answers < 10 * count; ++answers) {
      const int status = next();
      good += status == UNISIM_FRAME_OK ? 1 : 0;
      if (status != UNISIM_FRAME_OK) lines += message + " | ";
      if (status == UNISIM_FRAME_FAILED || status == UNISIM_FRAME_END) break;
    }
    return lines;
  }
  unisim_v4l2_statistics statistics() const {
    unisim_v4l2_statistics all{};
    all.struct_size = sizeof all;
    unisim_v4l2_get_statistics(source, &all);
    return all;
  }

  unisim_source* source = nullptr;
  int32_t problem = 0;
  unisim_frame frame{};
  std::string message;
};

unisim_v4l2_config config_of(int32_t width, int32_t height, double fps, const char* format) {
  unisim_v4l2_config config;
  unisim_v4l2_config_init(&config, sizeof config);
  config.width = width;
  config.height = height;
  config.fps = fps;
  config.pixel_format = format;
  // The machine may stand still for a while where it is emulated.
  config.frame_timeout_ms = 60000;
  return config;
}

int gray_levels(const unisim_image& image) {
  std::set<uint8_t> levels;
  for (int32_t x = 0; x < image.width; ++x) {
    levels.insert(image.data[ptrdiff_t{image.height / 2} * image.stride + x]);
  }
  return static_cast<int>(levels.size());
}

void list_cameras() {
  char table[4096];
  const int32_t cameras = unisim_v4l2_list(table, sizeof table, nullptr);
  const std::string text = table;
  check(cameras == 1 && text.find("platform:vivid-000") != std::string::npos &&
            text.find("YUYV") != std::string::npos,
        "the camera is listed", cameras == 1 ? "" : text);
}

// The rate is that of the stamps over the camera's own count: how fast the emulator is does not
// matter.
void stream(int32_t width, int32_t height, double fps, const char* format) {
  const std::string what = std::string("frames of ") + format;
  Run run(config_of(width, height, fps, format));
  if (run.source == nullptr) return check(false, what.c_str(), run.message);
  run.read(1);
  const unisim_frame first = run.frame;
  bool growing = true;
  bool whole = true;
  int64_t last_ns = first.timestamp_ns;
  for (int i = 0; i < 30; ++i) {
    run.read(1);
    growing = growing && run.frame.timestamp_ns > last_ns;
    last_ns = run.frame.timestamp_ns;
    whole = whole && run.frame.image.width == width && run.frame.image.height == height &&
            gray_levels(run.frame.image) >= 5;
  }
  const auto frames = static_cast<double>(run.frame.index - first.index);
  const double rate = frames * 1e9 / static_cast<double>(last_ns - first.timestamp_ns);
  char details[160];
  std::snprintf(details, sizeof details, "%.1f of %.1f frames per second, %lld lost", rate, fps,
                static_cast<long long>(run.statistics().lost));
  check(run.statistics().frames == 31 && growing && whole && std::abs(rate - fps) < 0.15 * fps,
        what.c_str(), details);
}

// Printed, and held to no more than that a frame is not kept: the machine is emulated, several
// times slower than a board.
void latency() {
  constexpr int kPoses = 120;
  constexpr double kLongest = 500.0;  // ms
  Run run(config_of(640, 480, 25, "GREY"));
  if (run.source == nullptr) return check(false, "from stamp to pose", run.message);
  const PoseAges ages = pose_ages(run.source, kPoses);
  check(ages.poses == kPoses && ages.in_order && ages.p95_ms < kLongest, "from stamp to pose",
        ages.text());
}

void damaged_frames() {
  Run run(config_of(320, 180, 30, "GREY"));
  run.read(3);
  check(set_control("/dev/video0", "Inject V4L2_BUF_FLAG_ERROR", 1), "control of damage");
  const std::string lines = run.read(10);
  check(run.statistics().errors >= 1 && run.statistics().restarts == 0,
        "a damaged frame is passed over", lines);
}

void broken_stream() {
  Run run(config_of(320, 180, 30, "YUYV"));
  run.read(3);
  check(set_control("/dev/video0", "Inject Fatal Streaming Error", 1), "control of the stream");
  const std::string lines = run.read(10);
  check(run.statistics().restarts >= 1 && run.statistics().frames >= 13,
        "a broken stream is started anew", lines);
}

void dropped_frames() {
  check(set_control("/dev/video0", "Percentage of Dropped Buffers", 50), "control of drops");
  {
    Run run(config_of(320, 180, 30, "GREY"));
    run.read(20);
    check(run.statistics().lost > 0 && run.frame.index >= 20, "dropped frames are counted",
          std::to_string(run.statistics().lost));
  }
  set_control("/dev/video0", "Percentage of Dropped Buffers", 0);
}

void refused_calls() {
  for (const char* call : {"VIDIOC_REQBUFS", "VIDIOC_QBUF", "VIDIOC_STREAMON"}) {
    const std::string control = std::string("Inject ") + call + " Error";
    check(set_control("/dev/video0", control.c_str(), 1), control.c_str());
    const unisim_v4l2_config config = config_of(320, 180, 30, "GREY");
    const Run refused(config);
    check(refused.source == nullptr && refused.message.find(call) != std::string::npos,
          "a refused call is named", refused.message);
    Run again(config);
    if (again.source != nullptr) again.read(2);
    check(again.source != nullptr && again.statistics().frames == 2, "and works the next time");
  }
}

void busy_camera() {
  Run first(config_of(320, 180, 30, "GREY"));
  const Run second(config_of(320, 180, 30, "GREY"));
  check(second.source == nullptr && second.problem == UNISIM_V4L2_BUSY, "a busy camera is told",
        second.message);
}

void unplugged() {
  Run run(config_of(320, 180, 30, "YUYV"));
  run.read(3);
  const int64_t last_ns = run.frame.timestamp_ns;
  check(set_control("/dev/video0", "Disconnect", 1), "control of the plug");
  int status = UNISIM_FRAME_OK;
  for (int i = 0; i < 10 && status == UNISIM_FRAME_OK; ++i) status = run.next();
  check(status == UNISIM_FRAME_BAD && run.message.find("unplugged") != std::string::npos,
        "unplugging is told", run.message);
  // Now nothing of ours is open: the module can go, and come back under another number.
  check(std::system("/load_camera 3") == 0, "plugging in again");
  const std::string lines = run.read(10);
  check(run.statistics().reconnects == 1 && lines.find("/dev/video3") != std::string::npos &&
            run.frame.timestamp_ns > last_ns,
        "the camera is found under another number", lines);
}

}  // namespace

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  list_cameras();
  stream(640, 480, 25, "YUYV");
  stream(640, 360, 30, "GREY");
  stream(320, 180, 60, "NV12");
  latency();
  damaged_frames();
  broken_stream();
  dropped_frames();
  refused_calls();
  busy_camera();
  unplugged();
  std::printf("\nRESULT %s\n", failures == 0 ? "all is well" : "there were failures");
  return failures == 0 ? 0 : 1;
}
