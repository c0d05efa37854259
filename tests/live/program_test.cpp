// SPDX-License-Identifier: MIT
// unisim-live as its users start it; a recording stands for the camera.
#include "tests/replay/program.hpp"

#include <chrono>
#include <filesystem>
#include <sstream>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

ProgramResult run_live(const std::vector<std::string>& arguments,
                       const Disturbance& disturbance = {}) {
  return run_program(UNISIM_LIVE_PROGRAM, arguments, disturbance);
}

}  // namespace

TEST_CASE("a live run is replayed from its recording, pose by pose") {
  const TempFolder folder;
  const ProgramResult live =
      run_live({"--device", rendered_sequence(), "--out", folder / "live", "--quiet"});
  INFO(live.err);
  REQUIRE(live.code == 0);
  const ProgramResult replay = run_replay(
      {folder / "live/recording", "--out", folder / "replay", "--every-frame", "--quiet"});
  INFO(replay.err);
  REQUIRE(replay.code == 0);
  for (const char* name : {"trajectory_live.tum", "trajectory.tum", "trajectory_frames.tum"}) {
    INFO(name);
    const std::string first = read_file(folder / ("live/" + std::string(name)));
    CHECK(first.size() > 200);
    const bool same = first == read_file(folder / ("replay/" + std::string(name)));
    CHECK(same);
  }
}

TEST_CASE("a live run without a folder writes nothing and ends well") {
  const ProgramResult live = run_live({"--device", small_sequence()});
  INFO(live.err);
  CHECK(live.code == 0);
  CHECK(has(live.err, "pose age"));
}

TEST_CASE("a live run that finds no start says why") {
  const ProgramResult live = run_live({"--device", still_sequence()});
  INFO(live.err);
  CHECK(has(live.err, "no start: "));
  CHECK(has(live.err, "move the camera sideways"));
}

TEST_CASE("a recording that plays a camera is stamped with the time of day and its ages are told") {
  const TempFolder folder;
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  const ProgramResult live =
      run_live({"--device", rendered_sequence(), "--as-camera", "--out", folder / "out"});
  const auto after = std::chrono::system_clock::now().time_since_epoch();
  INFO(live.err);
  REQUIRE(live.code == 0);
  CHECK(has(live.err, "from the stamp of the frame to the pose p50"));
  std::istringstream poses(read_file(folder / "out/trajectory_live.tum"));
  std::string line;
  int count = 0;
  while (std::getline(poses, line)) {
    if (line.front() == '#') continue;
    const std::chrono::duration<double> stamp(std::stod(line));
    CHECK(stamp > before);
    CHECK(stamp < after);
    ++count;
  }
  CHECK(count > 20);
}

TEST_CASE("an interrupt ends the wait for a frame of a played camera") {
  const TempFolder folder;
  // The second frame is due in a day.
  std::filesystem::create_directory(folder / "long");
  std::filesystem::create_directory_symlink(rendered_sequence() + "/rgb", folder / "long/rgb");
  std::istringstream list(read_file(rendered_sequence() + "/rgb.txt"));
  std::string names;
  std::string line;
  for (int k = 0; k < 3 && std::getline(list, line);) {
    if (line.front() == '#') continue;
    names += std::to_string(k++ * 86400) + line.substr(line.find(' ')) + "\n";
  }
  write_file(folder / "long/rgb.txt", names);
  Disturbance stop;
  stop.interrupt_on = "INIT";
  const auto start = std::chrono::steady_clock::now();
  const ProgramResult live =
      run_live({"--device", folder / "long", "--format", "tum", "--as-camera"}, stop);
  INFO(live.err);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
}

TEST_CASE("a mask that does not fit a camera's images is refused in one line, before the run") {
  const TempFolder folder;
  write_file(folder / "mask.pgm", "P5 40 30 255\n" + std::string(40 * 30, '\1'));
  const ProgramResult live = run_live({"--device", rendered_sequence(), "--as-camera", "--mask",
                                       folder / "mask.pgm", "--out", folder / "out"});
  CHECK(live.code == 3);
  CHECK(live.err == "unisim-live: " + (folder / "mask.pgm") +
                        ": the mask has 40x30 pixels, the frames 320x240; give a mask of their "
                        "size\n");
}

TEST_CASE("a disk that takes no more images ends the recording in one line that says why") {
  const TempFolder folder;
  Disturbance full;
  full.max_file_bytes = 20000;
  const ProgramResult live = run_live(
      {"--device", rendered_sequence(), "--out", folder / "out", "--no-report", "--quiet"}, full);
  INFO(live.err);
  CHECK(live.code == 4);
  CHECK(has(live.err,
            "recording: File too large; the recording ends after 0 frames, tracking "
            "goes on\n"));
  CHECK_FALSE(has(live.err, "libpng"));
  CHECK_FALSE(std::filesystem::exists(folder / "out/recording/rgb/000000.png"));
}

TEST_CASE("what cannot be opened is named, with what to do") {
  const ProgramResult absent = run_live({"--device", "/dev/video77"});
  CHECK(absent.code == 3);
  CHECK(has(absent.err, "unisim-live: /dev/video77: "));
  const ProgramResult size = run_live({"--size", "640"});
  CHECK(size.code == 2);
  CHECK(has(size.err, "--size is \"640\", must be WIDTHxHEIGHT"));
  const ProgramResult played = run_live({"--device", "/dev/video0", "--as-camera"});
  CHECK(played.code == 2);
  CHECK(has(played.err, "--as-camera goes with a recorded sequence"));
  const ProgramResult recorded = run_live({"--predictor", "recorded", "--predictions", "x"});
  CHECK(recorded.code == 2);
}
