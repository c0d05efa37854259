// SPDX-License-Identifier: MIT
// unisim-replay with odometry: results in metres, and it says so.
#include <nlohmann/json.hpp>

#include "tests/replay/damaged_sequence.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

nlohmann::json summary_of(const std::string& folder) {
  return nlohmann::json::parse(read_file(folder + "/summary.json"));
}

}  // namespace

TEST_CASE("a replay with odometry is in metres") {
  const TempFolder folder;
  const std::string out = folder / "out";
  const ProgramResult result =
      run_replay({rendered_sequence(), "--out", out, "--stride", "2", "--quiet", "--odometry",
                  rendered_sequence() + "/groundtruth.txt"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(has(result.out, "metric: 1 unit = "));
  const nlohmann::json summary = summary_of(out);
  CHECK(summary["unit"] == "metric");
  CHECK(summary["metres_per_unit"].get<double>() > 0.0);
  CHECK(summary["scale_sigma"].get<double>() < 0.05);
  CHECK(summary["segment_scales"].size() == 1);
  CHECK(summary["distances"]["taken"].get<int>() > 0);
  // What aligns the trajectory with the truth is no scale any more.
  CHECK(summary["scale"].get<double>() == Approx(1.0).margin(0.03));
  CHECK(has(read_file(out + "/trajectory.tum"), "# unit of length: metre, known to "));
  const std::string live = read_file(out + "/trajectory_live.tum");
  CHECK(has(live, "# unit of length: arbitrary"));
  CHECK(has(live, "# from here on 1 unit = "));
  CHECK(has(read_file(out + "/keyframes.csv"), ",metric,"));
  CHECK(has(read_file(out + "/report.html"), "metric, "));
}

TEST_CASE("a replay without says that it is relative") {
  const TempFolder folder;
  const std::string out = folder / "out";
  REQUIRE(run_replay({rendered_sequence(), "--out", out, "--stride", "2", "--quiet"}).code == 0);
  const nlohmann::json summary = summary_of(out);
  CHECK(summary["unit"] == "relative");
  CHECK(summary["metres_per_unit"].is_null());
  CHECK(summary["segment_scales"].empty());
  CHECK(has(read_file(out + "/trajectory.tum"), "# unit of length: arbitrary"));
  CHECK(has(read_file(out + "/keyframes.csv"), ",relative,"));
}

TEST_CASE("the camera's height over the floor makes a replay metric") {
  const TempFolder folder;
  const std::string out = folder / "out";
  // The rendered corridor is walked through at 1.5 m, the eye swaying by some centimetres.
  const ProgramResult result = run_replay(
      {rendered_sequence(), "--out", out, "--stride", "2", "--quiet", "--camera-height", "1.5"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const nlohmann::json summary = summary_of(out);
  CHECK(summary["unit"] == "metric");
  CHECK(summary["scale"].get<double>() == Approx(1.0).margin(0.1));
  CHECK(summary["scale_sigma"].get<double>() >= 0.02);
  CHECK(run_replay({rendered_sequence(), "--out", folder / "no", "--camera-height", "0"}).code ==
        2);
}

TEST_CASE("odometry that cannot be read is bad input, in one line") {
  const TempFolder folder;
  write_file(folder / "odometry.txt", "1 2 3\n2 3\n");
  const ProgramResult bad = run_replay(
      {rendered_sequence(), "--out", folder / "out", "--odometry", folder / "odometry.txt"});
  CHECK(bad.code == 3);
  CHECK(has(bad.err, "odometry.txt:2: not as many numbers as before"));
  CHECK(lines_in(bad.err) == 1);
  const ProgramResult none =
      run_replay({rendered_sequence(), "--out", folder / "out", "--odometry", folder / "none.txt"});
  CHECK(none.code == 3);
  CHECK(has(none.err, "none.txt"));
}
