// SPDX-License-Identifier: MIT
// Images that are missing are gaps: time and truth go by the number in the name.
#include <cstdio>

#include "drivers/sequence/frame_numbers.hpp"
#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using unisim::sequence::frame_numbers;

namespace {

constexpr const char* kTailOfPose[] = {"", " 0 0 0 1"};

std::string six_digits(int number) {
  char text[16];
  std::snprintf(text, sizeof text, "%06d", number);
  return text;
}

void write_numbered(const TempFolder& folder, const std::string& prefix,
                    const std::vector<int>& numbers) {
  for (const int number : numbers) {
    write_image(folder, prefix + six_digits(number) + ".png", number);
  }
}

// Line k has x = k.
std::string pose_lines(int count, bool four_rows) {
  std::string lines;
  for (int k = 0; k < count; ++k) {
    lines += "1 0 0 " + std::to_string(k) + " 0 1 0 0 0 0 1 0" + kTailOfPose[four_rows] + "\n";
  }
  return lines;
}

std::string time_lines(int count) {
  std::string lines;
  for (int k = 0; k < count; ++k) lines += std::to_string(k) + ".25\n";
  return lines;
}

// Each frame has, at its time, the pose with x = its brightness plus `shift`.
void require_paired(const Source& source, size_t frames, int shift = 0) {
  const auto answers = play(source);
  REQUIRE(answers.size() == frames);
  const auto truth = truth_of(source);
  for (size_t k = 0; k < frames; ++k) {
    REQUIRE(answers[k].status == UNISIM_FRAME_OK);
    REQUIRE(answers[k].index == static_cast<int64_t>(k));
    bool found = false;
    for (const unisim_stamped_pose& pose : truth) {
      if (pose.timestamp_ns != answers[k].timestamp_ns) continue;
      REQUIRE(pose.T_world_cam.t[0] == answers[k].pixel + shift);
      found = true;
    }
    REQUIRE(found);
  }
}

}  // namespace

TEST_CASE("replica: missing images keep time and pose of their number") {
  const TempFolder folder;
  write_numbered(folder, "results/frame", {0, 1, 4, 7});
  folder.write("traj.txt", pose_lines(8, true));
  const Source source = open_sequence(folder.path());
  require_paired(source, 4);
  REQUIRE(play(open_sequence(folder.path()))[2].timestamp_ns == 133333333);
  REQUIRE(has(notes_of(source), "numbered 0 to 7 and 4 of these 8 are there"));
}

TEST_CASE(
    "replica: numbers beyond the list are paired in order where that can be, and it is told") {
  const TempFolder folder;
  write_numbered(folder, "results/frame", {1, 2, 3});
  SECTION("as many lines as images") {
    folder.write("traj.txt", pose_lines(3, true));
    const Source source = open_sequence(folder.path());
    require_paired(source, 3, -1);
    REQUIRE(has(notes_of(source), "3 lines for 3 images numbered 1 to 3: paired in order"));
  }
  SECTION("fewer lines") {
    folder.write("traj.txt", pose_lines(2, true));
    const Source source = open_sequence(folder.path());
    REQUIRE(play(source).size() == 3);
    REQUIRE(truth_of(source).size() == 2);
    REQUIRE(has(notes_of(source), "2 lines for 3 images numbered 1 to 3"));
  }
}

TEST_CASE("kitti: missing images keep time and pose of their number") {
  const TempFolder folder;
  write_numbered(folder, "sequences/07/image_2/", {0, 1, 4, 7});
  const bool has_times = GENERATE(true, false);
  if (has_times) folder.write("sequences/07/times.txt", time_lines(8));
  folder.write("poses/07.txt", pose_lines(8, false));
  const Source source = open_sequence(folder.path());
  require_paired(source, 4);
  const auto again = play(open_sequence(folder.path()));
  REQUIRE(again[3].timestamp_ns == (has_times ? 7250000000 : 700000000));
}

TEST_CASE("kitti: poses of the images that are there are paired in order, and it is told") {
  const TempFolder folder;
  write_numbered(folder, "sequences/07/image_2/", {5, 6, 7});
  folder.write("sequences/07/times.txt", time_lines(8));
  folder.write("poses/07.txt", pose_lines(3, false));
  const Source source = open_sequence(folder.path());
  require_paired(source, 3, -5);
  REQUIRE(has(notes_of(source), "a line for each image: paired in order"));
}

TEST_CASE("kitti: numbers beyond times.txt are refused, but for as many times as images") {
  const TempFolder folder;
  write_numbered(folder, "image_0/", {1, 2, 9});
  folder.write("times.txt", time_lines(3));
  REQUIRE(play(open_sequence(folder.path()))[2].timestamp_ns == 2250000000);
  folder.write("times.txt", time_lines(8));
  REQUIRE(has(open_failure(folder.path()), "8 lines for 3 images numbered 1 to 9"));
}

TEST_CASE("kitti: a timed ground truth gives missing images the time of their number") {
  const TempFolder folder;
  write_numbered(folder, "sequences/07/image_2/", {0, 2});
  folder.write("poses/07.txt", "0 0 0 0 0 0 0 1\n0.3 1 0 0 0 0 0 1\n0.7 2 0 0 0 0 0 1\n");
  require_paired(open_sequence(folder.path()), 2);
}

TEST_CASE("kitti: times in nanoseconds are read as such") {
  const TempFolder folder;
  write_numbered(folder, "image_0/", {0, 1});
  folder.write("times.txt", "1400000000000000000\n1400000000100000000\n");
  const auto answers = play(open_sequence(folder.path()));
  REQUIRE(answers[1].timestamp_ns == 1400000000100000000);
}

TEST_CASE("7scenes: missing images keep time and pose of their number") {
  const TempFolder folder;
  for (const int number : {2, 3, 9}) {
    const std::string name = "frame-" + six_digits(number);
    write_image(folder, name + ".color.png", number);
    folder.write(name + ".pose.txt",
                 "1 0 0 " + std::to_string(number) + "\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  }
  const Source source = open_sequence(folder.path());
  require_paired(source, 3);
  REQUIRE(has(notes_of(source), "numbered 2 to 9 and 3 of these 8 are there"));
}

TEST_CASE("images: numbers that are missing are gaps in time") {
  const TempFolder folder;
  write_numbered(folder, "images/left01_", {101, 102, 105});
  const std::string part = GENERATE(as<std::string>{}, "images", "images/left*.png");
  const Source source = open_sequence(folder / part, nullptr, 0, 0, 10);
  const auto answers = play(source);
  REQUIRE(answers[0].timestamp_ns == 0);
  REQUIRE(answers[1].timestamp_ns == 100000000);
  REQUIRE(answers[2].timestamp_ns == 400000000);
  REQUIRE(answers[2].index == 2);
  REQUIRE(has(notes_of(source), "numbered 101 to 105 and 3 of these 5 are there"));
}

TEST_CASE("images: names without one number of their own are said to be timed by place") {
  const TempFolder folder;
  for (const char* name : {"left_1.png", "left_2.png", "right_1.png"}) write_image(folder, name, 1);
  const Source source = open_sequence(folder.path(), nullptr, 0, 0, 10);
  REQUIRE(play(source)[2].timestamp_ns == 200000000);
  REQUIRE(has(notes_of(source), "gaps between them are not seen"));
}

TEST_CASE("images: names that are times are read as times") {
  const TempFolder folder;
  SECTION("seconds") {
    for (const char* name : {"1305031102.175304.png", "1305031102.211214.png"}) {
      write_image(folder, name, 1);
    }
    REQUIRE(play(open_sequence(folder.path()))[1].timestamp_ns == 1305031102211214000);
  }
  SECTION("nanoseconds") {
    for (const char* name : {"1403715273262142976.png", "1403715273312143104.png"}) {
      write_image(folder, name, 1);
    }
    REQUIRE(play(open_sequence(folder.path()))[1].timestamp_ns == 1403715273312143104);
  }
  SECTION("seconds of no date begin at 0, as numbers do") {
    for (const char* name : {"1000.000000.png", "1000.040000.png"}) write_image(folder, name, 1);
    REQUIRE(play(open_sequence(folder.path()))[0].timestamp_ns == 0);
    REQUIRE(play(open_sequence(folder.path()))[1].timestamp_ns == 40000000);
  }
  SECTION("a version is no time") {
    for (const char* name : {"1.9.png", "1.10.png"}) write_image(folder, name, 1);
    REQUIRE(play(open_sequence(folder.path()))[1].timestamp_ns == 33333333);
  }
}

TEST_CASE("the number of a name is the one in which names differ") {
  using Numbers = std::vector<int64_t>;
  REQUIRE(frame_numbers({"cam0_000009.png", "cam0_000010.png"}) == Numbers{9, 10});
  REQUIRE(frame_numbers({"1_of_20.jpg", "2_of_20.png"}) == Numbers{1, 2});
  REQUIRE(frame_numbers({"a2/x7.png"}) == Numbers{7});
  REQUIRE(frame_numbers({"7.png", "7.jpg"}) == Numbers{7, 7});
  REQUIRE(frame_numbers({"1_1.png", "2_2.png"}).empty());
  REQUIRE(frame_numbers({"a.png", "b.png"}).empty());
  REQUIRE(frame_numbers({"1.png", "1b.png"}).empty());
  REQUIRE(frame_numbers({"20230101120000.png", "20230101120100.png"}) ==
          Numbers{20230101120000, 20230101120100});
  REQUIRE(frame_numbers({"1.png", "2000000000.png"}).empty());
  REQUIRE(frame_numbers({"1.png", "99999999999999999999.png"}).empty());
  REQUIRE(frame_numbers({}).empty());
}
