// SPDX-License-Identifier: MIT
// Maps that outlive the run: saved, gone on with, only looked into, refused.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "drivers/mapfile/sections.hpp"
#include "tests/replay/damaged_sequence.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "tools/eval/trajectory.hpp"

using namespace unisim::testing;
namespace mapfile = unisim::mapfile;

namespace {

using Arguments = std::vector<std::string>;

nlohmann::json summary_in(const std::string& out) {
  return nlohmann::json::parse(read_file(out + "/summary.json"));
}

/// A run over frames [from, to) of the rendered corridor.
Arguments part(const std::string& out, int from, int to, const Arguments& more = {}) {
  return with(arguments(rendered_sequence(), out),
              with({"--from", std::to_string(from), "--to", std::to_string(to)}, more));
}

/// The run over the first half, made once: half.map, out/.
const TempFolder& first_run() {
  static const TempFolder folder;
  static const int code =
      run_replay(part(folder / "out", 0, 40, {"--save-map", folder / "half.map"})).code;
  REQUIRE(code == 0);
  return folder;
}

const std::string& first_half() {
  static const std::string path = first_run() / "half.map";
  return path;
}

/// Largest distance of two trajectories at the times that both have, over the length of the first.
double apart(const std::string& one, const std::string& other) {
  const unisim::eval::Trajectory a = unisim::eval::read_trajectory(one);
  const unisim::eval::Trajectory b = unisim::eval::read_trajectory(other);
  const double length = (a.poses.back().t - a.poses.front().t).norm();
  double most = 0;
  int common = 0;
  for (const auto& x : a.poses) {
    for (const auto& y : b.poses) {
      if (std::abs(x.time_s - y.time_s) > 1e-6) continue;
      most = std::max(most, (x.t - y.t).norm());
      ++common;
    }
  }
  CHECK(common >= 9);
  return most / length;
}

void require_refused(const ProgramResult& result, int code, const std::string& part_of_line) {
  INFO(result.err);
  CHECK(result.code == code);
  CHECK(has(result.err, part_of_line));
  CHECK(lines_in(result.err) == 1);
}

}  // namespace

TEST_CASE("a run goes on in the map of an earlier one, and saves both") {
  const TempFolder folder;
  const std::string out = folder / "second";
  const std::string both = folder / "both.map";
  const ProgramResult result =
      run_replay(part(out, 40, 80, {"--load-map", first_half(), "--save-map", both}));
  INFO(result.err);
  REQUIRE(result.code == 0);
  const nlohmann::json summary = summary_in(out);
  CHECK(summary.at("keyframes") == 10);
  CHECK(summary.at("coverage") == 1.0);
  CHECK(summary.at("segments") == 1);
  CHECK(summary.at("map_loaded") == first_half());
  CHECK(poses_in(out + "/trajectory.tum") == 10);
  CHECK(poses_in(out + "/trajectory_map.tum") == 20);
  CHECK(lines_in(read_file(out + "/keyframes.csv")) == 11);
  CHECK(has(read_file(out + "/keyframes.csv"), "\n10,"));
  const ProgramResult score =
      run_program(UNISIM_EVAL_PROGRAM, {"ate", rendered_sequence() + "/groundtruth.txt",
                                        out + "/trajectory_map.tum", "--align", "sim3", "--json"});
  REQUIRE(score.code == 0);
  CHECK(nlohmann::json::parse(score.out).at("rmse") < 0.05);

  SECTION("the same again gives the same bytes") {
    const std::string again = folder / "again";
    REQUIRE(run_replay(part(again, 40, 80, {"--load-map", first_half()})).code == 0);
    CHECK(read_file(out + "/trajectory.tum") == read_file(again + "/trajectory.tum"));
  }
  SECTION("what was saved is gone on with") {
    const std::string third = folder / "third";
    REQUIRE(run_replay(part(third, 0, 20, {"--load-map", both})).code == 0);
    CHECK(poses_in(third + "/trajectory_map.tum") == 25);
    CHECK(summary_in(third).at("segments") == 1);
  }
}

TEST_CASE("keyframes that had left the window when the map was saved are known to later runs") {
  const TempFolder folder;
  const std::string map = folder / "narrow.map";
  write_file(folder / "narrow.toml",
             "[session]\nwindow_size = 3\nwindow_overlap = 1\nwindow_submaps = 2\n"
             "max_keyframes = 33\n");
  const auto narrow = [&](const std::string& out, int from, int to, const Arguments& more) {
    Arguments run = {rendered_sequence(),
                     "--out",
                     out,
                     "--quiet",
                     "--stride",
                     "2",
                     "--config",
                     folder / "narrow.toml",
                     "--from",
                     std::to_string(from),
                     "--to",
                     std::to_string(to)};
    return run_replay(with(run, more));
  };
  const std::string first = folder / "first";
  ProgramResult result = narrow(first, 0, 74, {"--save-map", map});
  INFO(result.err);
  REQUIRE(result.code == 0);
  REQUIRE(poses_in(first + "/trajectory.tum") == 37);
  const std::string second = folder / "second";
  result = narrow(second, 74, 78, {"--load-map", map, "--save-map", folder / "both.map"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(poses_in(second + "/trajectory_map.tum") == 39);
  CHECK(apart(first + "/trajectory.tum", second + "/trajectory_map.tum") < 0.02);
  const std::string third = folder / "third";
  result = narrow(third, 78, 80, {"--load-map", folder / "both.map"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(poses_in(third + "/trajectory_map.tum") == 40);
}

TEST_CASE("a map that knows its metre is localised in in metres") {
  const TempFolder folder;
  const std::string map = folder / "metric.map";
  const std::string truth = rendered_sequence() + "/groundtruth.txt";
  REQUIRE(run_replay({rendered_sequence(), "--out", folder / "first", "--quiet", "--stride", "2",
                      "--odometry", truth, "--save-map", map})
              .code == 0);
  const std::string out = folder / "out";
  const ProgramResult result = run_replay(
      {rendered_sequence(), "--out", out, "--from", "1", "--load-map", map, "--localise"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(has(result.out, "metric: 1 unit of the map = "));
  CHECK(has(read_file(out + "/trajectory.tum"), "# unit of length: metre, known to "));
  const nlohmann::json summary = summary_in(out);
  CHECK(summary.at("unit") == "metric");
  CHECK(summary.at("scale_sigma") > 0.0);
  const ProgramResult score = run_program(
      UNISIM_EVAL_PROGRAM, {"ate", truth, out + "/trajectory.tum", "--align", "sim3", "--json"});
  REQUIRE(score.code == 0);
  CHECK(nlohmann::json::parse(score.out).at("scale") == Approx(1.0).margin(0.03));
}

TEST_CASE("a run that only localises finds the frames and leaves the map as it is") {
  const TempFolder folder;
  const std::string out = folder / "out";
  const std::string before = read_file(first_half());
  const ProgramResult result =
      run_replay({rendered_sequence(), "--out", out, "--quiet", "--from", "1", "--to", "40",
                  "--load-map", first_half(), "--localise"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(has(result.out, "39 of 39 frames found"));
  const nlohmann::json summary = summary_in(out);
  CHECK(summary.at("frames") == 39);
  CHECK(summary.at("located") == 39);
  CHECK(summary.at("ate_rmse_m") < 0.05);
  CHECK(poses_in(out + "/trajectory.tum") == 39);
  CHECK(lines_in(read_file(out + "/localised.csv")) == 40);
  CHECK(read_file(first_half()) == before);
  // In the frame and the unit of the map.
  CHECK(apart(first_run() / "out/trajectory.tum", out + "/trajectory.tum") < 0.02);
}

TEST_CASE("options of maps that do not go together are bad usage") {
  const TempFolder folder;
  const auto refuse = [&](const Arguments& more, const std::string& line) {
    require_refused(run_replay(part(folder / "out", 0, 20, more)), 2, line);
  };
  refuse({"--localise"}, "--localise needs --load-map");
  refuse({"--localise", "--load-map", first_half(), "--save-map", folder / "m"}, "--save-map");
  refuse({"--load-map", first_half(), "--record", folder / "r"}, "--record");
  refuse({"--save-map", folder / "m", "--predictor", "recorded", "--predictions", "x"},
         "maps are kept by the geometric predictor");
  refuse({"--save-map", first_half()}, "--force");
}

TEST_CASE("where a map cannot be written is known before the work starts") {
  const TempFolder folder;
  require_refused(run_replay(part(folder / "out", 0, 20, {"--save-map", folder / "no/m.map"})), 4,
                  "cannot be written");
  CHECK(!std::filesystem::exists(folder / "out/summary.json"));
}

TEST_CASE("a map that is not whole is refused by the name of the part") {
  const TempFolder folder;
  const std::string whole = read_file(first_half());
  std::string bad;
  std::string said;
  SECTION("absent") { said = "no such map"; }
  SECTION("foreign") {
    bad = read_file(rendered_sequence() + "/groundtruth.txt");
    said = "no map of libunisim";
  }
  SECTION("cut") {
    bad = whole.substr(0, whole.size() / 2);
    said = "is cut off";
  }
  SECTION("flipped") {
    bad = whole;
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
    said = "part predictor is damaged";
  }
  const std::string path = folder / "bad.map";
  if (!bad.empty()) write_file(path, bad);
  for (const char* how : {"--quiet", "--localise"}) {
    const ProgramResult result =
        run_replay(part(folder / "out", 40, 60, {"--load-map", path, how}));
    require_refused(result, 3, said);
    CHECK(has(result.err, "bad.map"));
  }
}

TEST_CASE("a map made up with right checksums is refused by the name of the part") {
  const TempFolder folder;
  const std::string path = folder / "bad.map";
  std::vector<mapfile::Section> sections = mapfile::read_sections(first_half());
  REQUIRE(sections.size() == 4);
  std::string said;
  SECTION("a part is missing") {
    sections.erase(sections.begin() + 2);
    said = "part predictor is missing";
  }
  SECTION("a part goes on after its end") {
    sections[2].bytes.push_back(0);
    said = "part predictor: there is more in it";
  }
  SECTION("counts that are not there") {
    for (const size_t at : {164U, 165U, 166U, 167U}) sections[2].bytes[at] = 0xff;
    said = "part predictor: ";
  }
  SECTION("the session's part is of something else") {
    sections[1].bytes.assign(1000, 0x55);
    said = "part session: ";
  }
  SECTION("windows of keyframes that are not there") {
    sections[3].bytes.back() = 0x7f;
    said = "part windows: ";
  }
  SECTION("the parts are of two maps") {
    const std::string other = folder / "other.map";
    REQUIRE(run_replay(part(folder / "first", 0, 24, {"--save-map", other})).code == 0);
    sections[1] = mapfile::read_sections(other)[1];
    said = "part session ends with keyframe 5, part predictor with keyframe 9";
  }
  mapfile::write_sections(path, sections);
  require_refused(run_replay(part(folder / "out", 40, 60, {"--load-map", path})), 3, said);
}

TEST_CASE("another size of images and another shape of the session are refused with both numbers") {
  const TempFolder folder;
  require_refused(
      run_replay(with(arguments(small_sequence(), folder / "out"), {"--load-map", first_half()})),
      3, "have 320x240 pixels, those of " + small_sequence() + " 160x120");
  require_refused(
      run_replay(part(folder / "out", 40, 60, {"--load-map", first_half(), "--window", "12"})), 3,
      "session.window_size = 16");
  require_refused(
      run_replay(part(folder / "out", 40, 60, {"--load-map", first_half(), "--focal", "200"})), 3,
      "the map was made with");
}

TEST_CASE("a map that does not fit on the disk leaves the old one, and the results") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  std::filesystem::copy_file(first_half(), path);
  Disturbance full;
  full.max_file_bytes = 300000;
  const ProgramResult result = run_replay(
      part(folder / "out", 40, 80, {"--load-map", path, "--save-map", path, "--no-report"}), full);
  INFO(result.err);
  CHECK(result.code == 4);
  CHECK(has(result.err, "room.map"));
  CHECK(read_file(path) == read_file(first_half()));
  CHECK(poses_in(folder / "out/trajectory.tum") == 10);
}
