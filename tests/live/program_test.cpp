// SPDX-License-Identifier: MIT
// unisim-live as its users start it; a recording stands for the camera.
#include "tests/replay/program.hpp"

#include <filesystem>

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

TEST_CASE("what cannot be opened is named, with what to do") {
  const ProgramResult absent = run_live({"--device", "/dev/video77"});
  CHECK(absent.code == 3);
  CHECK(has(absent.err, "unisim-live: /dev/video77: "));
  const ProgramResult size = run_live({"--size", "640"});
  CHECK(size.code == 2);
  CHECK(has(size.err, "--size is \"640\", must be WIDTHxHEIGHT"));
  const ProgramResult recorded = run_live({"--predictor", "recorded", "--predictions", "x"});
  CHECK(recorded.code == 2);
}
