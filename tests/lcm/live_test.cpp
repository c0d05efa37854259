// SPDX-License-Identifier: MIT
// unisim-live on images that another program sends.
#include <lcm/lcm.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "drivers/sequence/sequence.h"
#include "tests/lcm/child.hpp"
#include "tests/lcm/event_log.hpp"
#include "tests/lcm/image_log.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"
#include "unisim_keyframe_t.h"
#include "unisim_pose_t.h"

using namespace unisim::testing;
namespace fs = std::filesystem;

namespace {

/// Stamps as rgb.txt has them.
std::string stamp_text(int64_t ns) {
  const std::string fraction = std::to_string(1000000000 + ns % 1000000000);
  return std::to_string(ns / 1000000000) + "." + fraction.substr(1);
}

void send_position(lcm_t* odometer, const unisim_stamped_pose& truth) {
  unisim_pose_t pose{};
  pose.utime = truth.timestamp_ns / 1000;
  for (int k = 0; k < 3; ++k) pose.pos[k] = truth.T_world_cam.t[k];
  std::vector<uint8_t> bytes(static_cast<size_t>(unisim_pose_t_encoded_size(&pose)));
  const auto size = static_cast<int>(bytes.size());
  REQUIRE(unisim_pose_t_encode(bytes.data(), 0, size, &pose) == size);
  REQUIRE(lcm_publish(odometer, "ODOMETRY", bytes.data(), static_cast<unsigned>(size)) == 0);
}

}  // namespace

TEST_CASE("images that come over LCM are tracked, with the stamps they came with") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const TempFolder folder;
  Child live({UNISIM_LIVE_PROGRAM, "--device", "lcm://", "--out", folder / "out", "--quiet"});
  const Made made = make_publisher("");
  REQUIRE(made.publisher != nullptr);
  std::set<std::string> sent;
  // What is sent before it listens is not heard: sent until five have been recorded.
  const std::string fifth = folder / "out/recording/rgb/000004.png";
  for (int lap = 0; lap < 200 && !fs::exists(fifth); ++lap) {
    char message[256] = "";
    const LogSource images(
        unisim_sequence_open(small_sequence().c_str(), nullptr, message, sizeof message));
    INFO(message);
    REQUIRE(images != nullptr);
    unisim_frame frame{};
    while (images->next_frame(images.get(), 1, &frame) == UNISIM_FRAME_OK) {
      const int64_t stamp_ns = (int64_t{1000} * lap + frame.index + 1) * 40000000;
      unisim_lcm_publish_image(made.publisher.get(), stamp_ns, &frame.image);
      sent.insert(stamp_text(stamp_ns));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  live.send_signal(SIGTERM);
  live.end();
  REQUIRE(fs::exists(fifth));
  std::ifstream list(folder / "out/recording/rgb.txt");
  std::string line;
  int recorded = 0;
  while (std::getline(list, line)) {
    if (line.front() == '#') continue;
    CHECK(sent.count(line.substr(0, line.find(' '))) == 1);
    ++recorded;
  }
  CHECK(recorded >= 5);
}

TEST_CASE("a mask that does not fit images over LCM ends the run at the first of them") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const TempFolder folder;
  write_file(folder / "mask.pgm", "P5 40 30 255\n" + std::string(40 * 30, '\1'));
  const Made made = make_publisher("");
  REQUIRE(made.publisher != nullptr);
  const std::vector<uint8_t> pixels(size_t{160} * 120, 90);
  const unisim_image image = {pixels.data(), 160, 120, 160, UNISIM_PIXEL_GRAY8};
  // What is sent before it listens is not heard: sent until it has ended.
  std::atomic<bool> ended{false};
  std::thread sender([&] {
    for (int64_t k = 1; !ended; ++k) {
      unisim_lcm_publish_image(made.publisher.get(), k * 40000000, &image);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  const ProgramResult live = run_program(
      UNISIM_LIVE_PROGRAM,
      {"--device", "lcm://", "--mask", folder / "mask.pgm", "--out", folder / "out", "--quiet"});
  ended = true;
  sender.join();
  CHECK(live.code == 4);
  CHECK(has(live.err,
            "unisim-live: geometric predictor: the mask has 40x30 pixels, the images 160x120; give "
            "a mask of the images' size"));
}

TEST_CASE("odometry that comes over LCM makes a live run metric") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const TempFolder folder;
  const std::string out = folder / "out";
  Child live({UNISIM_LIVE_PROGRAM, "--device", "lcm://", "--odometry", "lcm:ODOMETRY", "--stride",
              "2", "--out", out, "--no-report", "--quiet"});
  const Made made = make_publisher("");
  REQUIRE(made.publisher != nullptr);
  lcm_t* const odometer = lcm_create(nullptr);
  REQUIRE(odometer != nullptr);
  REQUIRE(lcm_publish(odometer, "ODOMETRY", "foreign", 7) == 0);
  char message[256] = "";
  const LogSource images(
      unisim_sequence_open(rendered_sequence().c_str(), nullptr, message, sizeof message));
  INFO(message);
  REQUIRE(images != nullptr);
  const unisim_stamped_pose* truth = nullptr;
  REQUIRE(images->ground_truth(images.get(), &truth) >= 80);
  unisim_frame frame{};
  for (int k = 0; images->next_frame(images.get(), 1, &frame) == UNISIM_FRAME_OK; ++k) {
    send_position(odometer, truth[k]);
    // None is dropped: the next one is sent when this one has been tracked and recorded.
    const std::string name = std::to_string(1000000 + k).substr(1);
    const fs::path recorded = out + "/recording/rgb/" + name + ".png";
    for (int tries = 0; tries < 20000 && !fs::exists(recorded); ++tries) {
      // What is sent before it listens is not heard.
      const bool again = k == 0 ? tries % 100 == 0 : tries == 0;
      const int64_t early_ns = k == 0 ? 1000000000 - int64_t{1000000} * tries : 0;
      if (again) {
        unisim_lcm_publish_image(made.publisher.get(), frame.timestamp_ns - early_ns, &frame.image);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    REQUIRE(fs::exists(recorded));
  }
  lcm_destroy(odometer);
  live.send_signal(SIGTERM);
  live.end();
  const std::string summary = read_file(out + "/summary.json");
  CHECK(has(summary, "\"unit\": \"metric\""));
}

TEST_CASE("poses of frames before the start of the map come as keyframes, not to act by") {
  const TempFolder folder;
  const ProgramResult live =
      run_program(UNISIM_LIVE_PROGRAM, {"--device", rendered_sequence(), "--as-camera", "--quiet",
                                        "--lcm", "file://" + (folder / "run.lcm") + "?mode=w"});
  INFO(live.err);
  REQUIRE(live.code == 0);
  std::set<int64_t> posed;
  std::set<int64_t> keyframes;
  int64_t newest = 0;
  for (const LogEvent& event : read_log(folder / "run.lcm")) {
    const auto size = static_cast<int>(event.data.size());
    if (event.channel == "UNISIM_POSE") {
      unisim_pose_t pose{};
      REQUIRE(unisim_pose_t_decode(event.data.data(), 0, size, &pose) == size);
      CHECK(pose.utime > newest);
      newest = pose.utime;
      posed.insert(pose.utime);
    } else if (event.channel == "UNISIM_KEYFRAME") {
      unisim_keyframe_t keyframe{};
      REQUIRE(unisim_keyframe_t_decode(event.data.data(), 0, size, &keyframe) == size);
      if (keyframes.empty()) CHECK((keyframe.id == 0 && posed.empty()));
      keyframes.insert(keyframe.utime);
    }
  }
  REQUIRE_FALSE(keyframes.empty());
  REQUIRE_FALSE(posed.empty());
  CHECK(*keyframes.begin() < *posed.begin());
}

TEST_CASE("a live run does not listen to itself, and names a URL that is no good") {
  const ProgramResult itself =
      run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://", "--lcm", "", "--lcm-images"});
  CHECK(itself.code == 2);
  CHECK(has(itself.err, "its own images"));
  const ProgramResult own =
      run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://", "--odometry", "lcm:UNISIM_POSE"});
  CHECK(own.code == 2);
  CHECK(has(own.err, "give the channel of the odometer's poses"));
  const ProgramResult many =
      run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://", "--odometry", "lcm:ODOM.*"});
  CHECK(many.code == 2);
  CHECK(has(many.err, "--odometry: lcm: channel 'ODOM.*'"));
  const ProgramResult file =
      run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://", "--odometry", "wheels.txt"});
  CHECK(file.code == 2);
  CHECK(has(file.err, "give lcm:CHANNEL"));
  const ProgramResult wrong = run_program(UNISIM_LIVE_PROGRAM, {"--device", "lcm://10.0.0.1:7667"});
  CHECK(wrong.code == 2);
  CHECK(has(wrong.err, "multicast"));
}
