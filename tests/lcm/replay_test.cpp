// SPDX-License-Identifier: MIT
// unisim-replay --lcm: what is published agrees with itself and with the files of the run.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/pipeline/similarity.hpp"
#include "tests/lcm/decoded.hpp"
#include "tests/lcm/event_log.hpp"
#include "tests/lcm/image_log.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "unisim_correction_t.h"
#include "unisim_image_t.h"
#include "unisim_keyframe_t.h"
#include "unisim_pose_t.h"
#include "unisim_status_t.h"
#include "unisim_trajectory_t.h"

using namespace unisim::testing;
using unisim::pipeline::compose;

namespace {

unisim_sim3 similarity(const double pos[3], const double wxyz[4], double scale) {
  return {{wxyz[1], wxyz[2], wxyz[3], wxyz[0]}, {pos[0], pos[1], pos[2]}, scale};
}

/// Holds the pose of the newest keyframe as README.md tells a consumer to.
class Consumer {
 public:
  void take(const LogEvent& event) {
    if (event.channel == "UNISIM_POSE") {
      const auto pose = decoded(event.data, unisim_pose_t_decode);
      ++poses;
      in_order = in_order && pose.utime > newest_utime;
      newest_utime = pose.utime;
    } else if (event.channel == "UNISIM_KEYFRAME") {
      take_keyframe(decoded(event.data, unisim_keyframe_t_decode));
    } else if (event.channel == "UNISIM_CORRECTION") {
      take_correction(decoded(event.data, unisim_correction_t_decode));
    }
  }

  int poses = 0;
  int taken = 0;      // keyframes as they came
  int optimised = 0;  // keyframes with a covariance
  int corrections = 0;
  bool in_order = true;
  bool revisions_grow = true;
  int64_t newest_utime = -1;
  int32_t newest_keyframe = -1;
  unisim_sim3 held{};

 private:
  void take_keyframe(const unisim_keyframe_t& keyframe) {
    ++(keyframe.covariance[0] < 0.0 ? taken : optimised);
    if (keyframe.id <= newest_keyframe) return;
    newest_keyframe = keyframe.id;
    held = similarity(keyframe.pos, keyframe.orientation, keyframe.scale);
  }
  void take_correction(const unisim_correction_t& correction) {
    ++corrections;
    revisions_grow = revisions_grow && correction.map_revision > revision_;
    revision_ = correction.map_revision;
    CHECK(correction.utime == newest_utime);
    CHECK(correction.keyframe == newest_keyframe);
    held = compose(
        similarity(correction.jump_pos, correction.jump_orientation, correction.jump_scale), held);
  }

  int32_t revision_ = 0;
};

/// Frame number `index` of the rendered sequence in gray.
cv::Mat rendered_gray(int index) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(small_sequence() + "/rgb")) {
    names.push_back(entry.path().string());
  }
  std::sort(names.begin(), names.end());
  const cv::Mat image = cv::imread(names.at(static_cast<size_t>(index)), cv::IMREAD_GRAYSCALE);
  REQUIRE_FALSE(image.empty());
  return image;
}

std::vector<std::vector<double>> read_tum(const std::string& path) {
  std::vector<std::vector<double>> poses;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream numbers(line);
    poses.emplace_back();
    for (double value = 0.0; numbers >> value;) poses.back().push_back(value);
  }
  return poses;
}

// Into run.lcm, beside the folder out.
void publish_run(const TempFolder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      rendered_sequence(), "--out", folder / "out",
      "--stride",          "2",     "--quiet",
      "--no-report",       "--lcm", "file://" + (folder / "run.lcm") + "?mode=w"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = run_replay(arguments);
  INFO(result.err);
  REQUIRE(result.code == 0);
}

}  // namespace

TEST_CASE("a status says what a start lacks") {
  const TempFolder folder;
  const std::string log = folder / "told.lcm";
  const ProgramResult run = run_replay(
      {still_sequence(), "--out", folder / "out", "--quiet", "--lcm", "file://" + log + "?mode=w"});
  INFO(run.err);
  CHECK(run.code == 3);
  CHECK(has(run.err, "no start"));
  int32_t reason = 0;
  for (const std::string& message : messages_on("UNISIM_STATUS", log)) {
    unisim_status_t status = decoded(message, unisim_status_t_decode);
    reason = status.reason;
    unisim_status_t_decode_cleanup(&status);
  }
  CHECK(reason == UNISIM_STATUS_T_REASON_STILL);
}

TEST_CASE("what unisim-replay publishes leads a consumer to the poses it writes") {
  const TempFolder folder;
  // In metres the same, though the unit changes on the way.
  const bool metric = GENERATE(false, true);
  if (metric) {
    publish_run(folder, {"--odometry", rendered_sequence() + "/groundtruth.txt"});
  } else {
    publish_run(folder);
  }
  Consumer consumer;
  for (const LogEvent& event : read_log(folder / "run.lcm")) consumer.take(event);
  CHECK(consumer.poses == 40);
  CHECK(consumer.taken == 40);
  CHECK(consumer.optimised > 30);
  CHECK(consumer.in_order);
  CHECK(consumer.corrections > 2);
  CHECK(consumer.revisions_grow);

  const std::vector<std::string> sent = messages_on("UNISIM_TRAJECTORY", folder / "run.lcm");
  REQUIRE_FALSE(sent.empty());
  auto trajectory = decoded(sent.back(), unisim_trajectory_t_decode);
  const std::vector<std::vector<double>> written = read_tum(folder / "out/trajectory.tum");
  REQUIRE(trajectory.n == 40);
  CHECK(trajectory.unit == (metric ? UNISIM_STATUS_T_UNIT_METRIC : UNISIM_STATUS_T_UNIT_RELATIVE));
  CHECK((trajectory.scale_sigma > 0.0) == metric);
  REQUIRE(written.size() == 40);
  for (int k = 0; k < 40; ++k) {
    const std::vector<double>& line = written[static_cast<size_t>(k)];
    CHECK(static_cast<double>(trajectory.poses[k].utime) == Approx(line[0] * 1e6).margin(1.0));
    for (size_t axis = 0; axis < 3; ++axis) {
      CHECK(trajectory.poses[k].pos[axis] == Approx(line[1 + axis]).margin(1e-9));
    }
  }
  // All jumps one after the other: where the newest keyframe is at the end.
  const unisim_trajectory_pose_t& last = trajectory.poses[39];
  CHECK(consumer.newest_keyframe == last.id);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(consumer.held.t[axis] == Approx(last.pos[axis]).margin(1e-9));
  }
  CHECK(consumer.held.s == Approx(last.scale).epsilon(1e-9));
  unisim_trajectory_t_decode_cleanup(&trajectory);
}

TEST_CASE("the state is published and the unit is said to be relative") {
  const TempFolder folder;
  publish_run(folder);
  const std::vector<std::string> sent = messages_on("UNISIM_STATUS", folder / "run.lcm");
  REQUIRE(sent.size() >= 2);
  auto first = decoded(sent.front(), unisim_status_t_decode);
  CHECK(first.state == UNISIM_STATUS_T_STATE_INIT);
  CHECK(first.keyframe == -1);
  auto last = decoded(sent.back(), unisim_status_t_decode);
  CHECK(last.state == UNISIM_STATUS_T_STATE_TRACKING);
  CHECK(last.unit == UNISIM_STATUS_T_UNIT_RELATIVE);
  CHECK(last.frames == 80);
  CHECK(last.n > 5);
  unisim_status_t_decode_cleanup(&first);
  unisim_status_t_decode_cleanup(&last);
}

TEST_CASE("a run that learns its metre says so, and from then on each message is in metres") {
  const TempFolder folder;
  publish_run(folder, {"--odometry", rendered_sequence() + "/groundtruth.txt"});
  const std::vector<std::vector<double>> truth = read_tum(rendered_sequence() + "/groundtruth.txt");
  bool metric = false;
  bool told = false;
  double jump = 1.0;
  std::vector<std::vector<double>> relative;
  std::vector<std::vector<double>> metres;
  for (const LogEvent& event : read_log(folder / "run.lcm")) {
    if (event.channel == "UNISIM_CORRECTION") {
      const auto correction = decoded(event.data, unisim_correction_t_decode);
      const bool now = correction.unit == UNISIM_STATUS_T_UNIT_METRIC;
      if (now != metric) jump = correction.jump_scale;
      CHECK((correction.scale_sigma > 0.0) == now);
      metric = now;
    } else if (event.channel == "UNISIM_POSE") {
      const auto pose = decoded(event.data, unisim_pose_t_decode);
      (metric ? metres : relative)
          .push_back(
              {1e-6 * static_cast<double>(pose.utime), pose.pos[0], pose.pos[1], pose.pos[2]});
    } else if (event.channel == "UNISIM_STATUS") {
      auto status = decoded(event.data, unisim_status_t_decode);
      told = status.unit == UNISIM_STATUS_T_UNIT_METRIC;
      CHECK((status.scale_sigma > 0.0) == told);
      unisim_status_t_decode_cleanup(&status);
    }
  }
  CHECK(told);
  REQUIRE(relative.size() > 5);
  REQUIRE(metres.size() > 10);
  CHECK(jump != Approx(1.0));
  // Metres of the way from first to last, over those of the truth.
  const auto over_truth = [&](const std::vector<std::vector<double>>& poses) {
    const auto at = [&](double time) {
      return *std::min_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
        return std::abs(a[0] - time) < std::abs(b[0] - time);
      });
    };
    const auto apart = [](const std::vector<double>& a, const std::vector<double>& b) {
      return std::hypot(a[1] - b[1], a[2] - b[2], a[3] - b[3]);
    };
    return apart(poses.front(), poses.back()) / apart(at(poses.front()[0]), at(poses.back()[0]));
  };
  CHECK(over_truth(metres) == Approx(1.0).margin(0.05));
  CHECK(over_truth(relative) * jump == Approx(1.0).margin(0.1));
}

TEST_CASE("unisim-replay refuses an LCM URL that is no good before it begins") {
  const TempFolder folder;
  const ProgramResult result = run_replay(
      {small_sequence(), "--out", folder / "out", "--lcm", "udpm://10.1.2.3:7667", "--quiet"});
  INFO(result.err);
  CHECK(result.code == 2);
  CHECK(has(result.err, "multicast"));
  CHECK(result.err.find('\n') == result.err.size() - 1);
  CHECK(run_replay({small_sequence(), "--out", folder / "out", "--lcm-images"}).code == 2);
}

TEST_CASE("a log of the images gives the poses of the folder they came from") {
  const TempFolder folder;
  std::string list;
  std::string log;
  for (int k = 0; k < 40; ++k) {
    const int64_t utime = 1000000 + 33333 * k;
    const std::string name = "rgb/" + std::to_string(k) + ".png";
    const cv::Mat image = rendered_gray(2 * k);
    folder.make_parent(name);
    REQUIRE(cv::imwrite(folder / name, image));
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.6f", static_cast<double>(utime) * 1e-6);
    list += std::string(seconds) + " " + name + "\n";
    const std::string pixels(reinterpret_cast<const char*>(image.data), image.total());
    log += event_bytes(k, utime, "CAMERA",
                       image_message(utime, image.cols, image.rows, image.cols,
                                     UNISIM_IMAGE_T_PIXEL_FORMAT_GRAY, pixels));
  }
  folder.write("rgb.txt", list);
  folder.write("run.lcm", log);
  const auto run = [&](const std::vector<std::string>& input, const std::string& out) {
    std::vector<std::string> all = input;
    all.insert(all.end(), {"--out", folder / out, "--stride", "2", "--quiet", "--no-report"});
    const ProgramResult result = run_replay(all);
    INFO(result.err);
    REQUIRE(result.code == 0);
    return read_file(folder / (out + "/trajectory.tum"));
  };
  const std::string from_log = run({folder / "run.lcm", "--format", "lcm"}, "from_log");
  CHECK(from_log == run({folder.path(), "--format", "tum"}, "from_folder"));
  CHECK(from_log ==
        run({folder / "run.lcm", "--lcm-image-channel", "CAMERA"}, "from_log_recognised"));
}

TEST_CASE("a channel that a log does not have is bad input") {
  const TempFolder folder;
  const std::string log = folder.write("run.lcm", gray_log(3, "CAMERA"));
  const ProgramResult result = run_replay(
      {log, "--lcm-image-channel", "LEFT", "--out", folder / "out", "--quiet", "--no-report"});
  CHECK(result.code == 3);
  CHECK(has(result.err, "CAMERA (3)"));
  CHECK(
      run_replay({small_sequence(), "--lcm-image-channel", "LEFT", "--out", folder / "out"}).code ==
      3);
}
