// SPDX-License-Identifier: MIT
// LCM event logs as sequences: channels, pixel formats, times, and damage of every kind.
#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "tests/lcm/event_log.hpp"
#include "tests/lcm/image_log.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"
#include "unisim_image_t.h"

using namespace unisim::testing;

namespace {

/// How far apart two colours are at most.
int distance(const cv::Vec3i& a, const cv::Vec3i& b) {
  int most = 0;
  for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

std::string repeated(const std::string& part, int times) {
  std::string text;
  for (int k = 0; k < times; ++k) text += part;
  return text;
}

}  // namespace

TEST_CASE("the images of a log are its frames, with their own times") {
  const TempFolder folder;
  const Played played = play_log(folder.write("run.lcm", gray_log(3)));
  CHECK(played.failure.empty());
  CHECK(played.notes.empty());
  CHECK(played.first_bytes == std::vector<int>{10, 11, 12});
  CHECK(played.times_ns == std::vector<int64_t>{1000000000, 1100000000, 1200000000});
  CHECK(played.bad.empty());
}

TEST_CASE("images without times take those of the log, which is said") {
  const TempFolder folder;
  std::string log;
  for (int k = 0; k < 2; ++k) log += event_bytes(k, 500 + k, "C", gray_message(0, 1));
  const Played played = play_log(folder.write("run.lcm", log));
  CHECK(played.times_ns == std::vector<int64_t>{500000, 501000});
  CHECK(has(played.notes, "those of the log"));
}

TEST_CASE("a log is recognised by its first bytes") {
  const TempFolder folder;
  const std::string path = folder.write("anything.bin", gray_log(2));
  char message[256] = "";
  const LogSource source(unisim_sequence_open(path.c_str(), nullptr, message, sizeof message));
  INFO(message);
  REQUIRE(source != nullptr);
  CHECK(std::string(source->format) == "lcm");
  CHECK(source->frame_count(source.get()) == 2);
}

TEST_CASE("the channel is the usual one, the only one, or the one that is named") {
  const TempFolder folder;
  const std::string other = event_bytes(9, 9, "POSE", "something else");
  const std::string one = folder.write("one.lcm", gray_log(2, "CAMERA") + other);
  CHECK(play_log(one).first_bytes.size() == 2);
  CHECK(has(play_log(one, "LEFT").failure, "CAMERA (2)"));
  const std::string two =
      folder.write("two.lcm", gray_log(2, "LEFT") + gray_log(3, "RIGHT") + other);
  CHECK(has(play_log(two).failure, "LEFT (2), RIGHT (3)"));
  CHECK(has(play_log(two).failure, "--lcm-image-channel"));
  CHECK(play_log(two, "RIGHT").first_bytes.size() == 3);
  const std::string usual = folder.write("usual.lcm", gray_log(2, "LEFT") + gray_log(4));
  CHECK(play_log(usual).first_bytes.size() == 4);
  CHECK(has(play_log(folder.write("none.lcm", other)).failure, "no image among 1 channels"));
}

TEST_CASE("foreign messages on the channel are counted and said once") {
  const TempFolder folder;
  const std::string foreign = event_bytes(9, 9, "UNISIM_IMAGE", "a message of another type");
  const Played played = play_log(folder.write("run.lcm", gray_log(2) + foreign + foreign));
  CHECK(played.first_bytes.size() == 2);
  CHECK(has(played.notes, "2 messages on channel 'UNISIM_IMAGE' are no images"));
}

TEST_CASE("all pixel formats give the same picture") {
  const TempFolder folder;
  const int width = 16, height = 16;
  const cv::Vec3i colour(40, 120, 200);  // blue green red
  const auto log_of = [&](int32_t pixelformat, const std::string& data, int32_t stride) {
    const std::string message = image_message(7, width, height, stride, pixelformat, data);
    return play_log(folder.write("run.lcm", event_bytes(0, 7, "C", message)));
  };
  const auto check_colour = [&](const Played& played, int tolerance) {
    INFO(played.failure);
    REQUIRE(played.bad.empty());
    REQUIRE(played.middle.size() == 1);
    CHECK(distance(played.middle[0], colour) <= tolerance);
  };
  const std::string bgr = repeated("\x28\x78\xC8", width * height);
  check_colour(log_of(UNISIM_IMAGE_T_PIXEL_FORMAT_BGR, bgr, 3 * width), 0);
  check_colour(log_of(UNISIM_IMAGE_T_PIXEL_FORMAT_BGR, bgr, 0), 0);
  const std::string rgb = repeated("\xC8\x78\x28", width * height);
  check_colour(log_of(UNISIM_IMAGE_T_PIXEL_FORMAT_RGB, rgb, 3 * width), 0);
  // BT.601, as cameras have it: Y 129, U 81, V 170.
  const std::string yuyv = repeated("\x81\x51\x81\xAA", width * height / 2);
  check_colour(log_of(UNISIM_IMAGE_T_PIXEL_FORMAT_YUYV, yuyv, 2 * width), 4);
  const cv::Mat picture(height, width, CV_8UC3, cv::Scalar(40, 120, 200));
  std::vector<uint8_t> jpeg;
  REQUIRE(cv::imencode(".jpg", picture, jpeg));
  check_colour(log_of(UNISIM_IMAGE_T_PIXEL_FORMAT_MJPEG, {jpeg.begin(), jpeg.end()}, 0), 4);
}

TEST_CASE("rows may be longer than pixels fill") {
  const TempFolder folder;
  const std::string rows = repeated(std::string(8, '\x20') + "####", 6);
  const std::string message = image_message(7, 8, 6, 12, UNISIM_IMAGE_T_PIXEL_FORMAT_GRAY, rows);
  const Played played = play_log(folder.write("run.lcm", event_bytes(0, 7, "C", message)));
  REQUIRE(played.middle.size() == 1);
  CHECK(played.middle[0] == cv::Vec3i(0x20, 0x20, 0x20));
}

TEST_CASE("an image that contradicts itself is a bad frame, the next one is read") {
  const TempFolder folder;
  const int32_t gray = UNISIM_IMAGE_T_PIXEL_FORMAT_GRAY;
  const std::string pixels(48, 'x');
  const std::vector<std::string> broken = {
      image_message(1, 8, 600, 8, gray, pixels),
      image_message(2, 8, 6, 100, gray, pixels),
      image_message(3, -8, 6, 8, gray, pixels),
      image_message(4, 8, 6, 8, 77, pixels),
      image_message(5, 7, 6, 14, UNISIM_IMAGE_T_PIXEL_FORMAT_YUYV, std::string(84, 'x')),
      image_message(6, 8, 6, 0, UNISIM_IMAGE_T_PIXEL_FORMAT_MJPEG, "\xFF\xD8 no more"),
      image_message(7, 8, 6, 0, UNISIM_IMAGE_T_PIXEL_FORMAT_MJPEG, ""),
      gray_message(8, 1).substr(0, 60)};
  std::string log = gray_log(1);
  for (const std::string& message : broken) log += event_bytes(0, 0, "UNISIM_IMAGE", message);
  log += event_bytes(0, 0, "UNISIM_IMAGE", gray_message(2000000, 99));
  // In the order of time, so that only the images themselves are at fault.
  const Played played = play_log(folder.write("run.lcm", log.substr(gray_log(1).size())));
  CHECK(played.first_bytes == std::vector<int>{99});
  REQUIRE(played.bad.size() == broken.size());
  for (const std::string& line : played.bad) {
    CHECK(has(line, "message at offset "));
    CHECK(has(line, "skipped"));
  }
}

TEST_CASE("a log cut off anywhere gives what is whole and says where it ends") {
  const TempFolder folder;
  const std::string log = gray_log(3);
  const size_t event = log.size() / 3;
  for (size_t size = 0; size < log.size(); ++size) {
    const Played played = play_log(folder.write("run.lcm", log.substr(0, size)));
    INFO(size);
    CHECK(played.first_bytes.size() == size / event);
    CHECK(played.failure.empty() == (size >= event));
    if (size < event || size % event == 0) continue;
    CHECK(has(played.notes, "at offset " + std::to_string(size / event * event)));
  }
}

TEST_CASE("damage in the middle costs the events it lies in") {
  const TempFolder folder;
  const std::string log = gray_log(5);
  const size_t event = log.size() / 5;
  std::string broken_sync = log;
  broken_sync[event] = 'x';
  std::string huge = log;
  huge.replace(event + 24, 4, "\x7F\xFF\xFF\xFF");
  std::string no_name = log;
  no_name.replace(event + 20, 4, std::string(4, '\0'));
  std::string hole = log;
  hole.erase(event + 40, 10);
  for (const std::string& bytes : {broken_sync, huge, no_name}) {
    const Played played = play_log(folder.write("run.lcm", bytes));
    CHECK(played.first_bytes == std::vector<int>{10, 12, 13, 14});
    CHECK(has(played.notes, "at offset " + std::to_string(event)));
  }
  // The length of the event with the hole reaches into the next one.
  const Played played = play_log(folder.write("run.lcm", hole));
  CHECK(played.first_bytes.front() == 10);
  CHECK(played.first_bytes.back() == 14);
  CHECK_FALSE(played.notes.empty());
}

TEST_CASE("whatever bytes a log has, it is read to its end") {
  const TempFolder folder;
  std::mt19937 random(11);
  const std::string log = gray_log(6);
  int good = 0;
  for (int round = 0; round < 400; ++round) {
    std::string bytes = log;
    for (int k = 0; k < 1 + round % 12; ++k) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    const Played played = play_log(folder.write("run.lcm", bytes));
    CHECK(played.first_bytes.size() <= 6);
    good += static_cast<int>(played.first_bytes.size());
  }
  CHECK(good > 400);
}
