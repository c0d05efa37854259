// SPDX-License-Identifier: MIT
// Runs that are disturbed: signals, readers that go away, names that are not text, full devices.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/replay/damaged_sequence.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "tools/common/text.hpp"

using namespace unisim::testing;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> kResults = {"trajectory.tum", "trajectory_live.tum",
                                           "keyframes.csv",  "summary.json",
                                           "map.ply",        "report.html"};

void require_results(const std::string& out) {
  for (const std::string& name : kResults) {
    INFO(name);
    CHECK(fs::exists(out + "/" + name));
  }
}

}  // namespace

TEST_CASE("Ctrl-C, termination and a terminal that closes write what there is and say so") {
  DamagedSequence sequence;
  sequence.spread_times(0.2);
  const TempFolder folder;
  const std::string out = folder / "out";
  Disturbance disturbance;
  disturbance.interrupt_on = "\"state\":\"tracking\"";
  disturbance.signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  const ProgramResult result = run_replay(
      {sequence.path(), "--out", out, "--stride", "2", "--realtime", "--json"}, disturbance);
  INFO(result.err);
  CHECK(result.code == 1);
  CHECK(has(result.err, "interrupted; what was known is written"));
  const int poses = poses_in(out + "/trajectory.tum");
  CHECK(poses >= 2);
  CHECK(poses < 40);
  const nlohmann::json summary = nlohmann::json::parse(read_file(out + "/summary.json"));
  CHECK(summary.at("outcome") == "interrupted");
}

TEST_CASE("a run that is killed leaves the live poses up to then") {
  DamagedSequence sequence;
  sequence.spread_times(0.1);
  const TempFolder folder;
  const std::string out = folder / "out";
  Disturbance disturbance;
  disturbance.interrupt_on = "\"state\":\"tracking\"";
  disturbance.signal = SIGKILL;
  const ProgramResult result = run_replay(
      {sequence.path(), "--out", out, "--stride", "2", "--realtime", "--json"}, disturbance);
  CHECK(result.code == 128 + SIGKILL);
  const std::string text = read_file(out + "/trajectory_live.tum");
  CHECK(text.back() == '\n');
  const std::string progress = result.out.substr(result.out.rfind("{\"type\":\"progress\""));
  CHECK(poses_in(out + "/trajectory_live.tum") >=
        nlohmann::json::parse(progress).at("keyframes").get<int>());
  std::vector<std::string> left;
  for (const fs::directory_entry& entry : fs::directory_iterator(out)) {
    left.push_back(entry.path().filename().string());
  }
  CHECK(left == std::vector<std::string>{"trajectory_live.tum"});
}

TEST_CASE("a wait for a frame that is hours away ends with the run") {
  DamagedSequence sequence;
  for (size_t k = 40; k < sequence.lines.size(); ++k) {
    sequence.set_time(k, sequence.time(k) + 36000.0);
  }
  sequence.save_list();
  const TempFolder folder;
  Disturbance disturbance;
  disturbance.interrupt_on = "\"state\":\"tracking\"";
  const ProgramResult result = run_replay(
      {sequence.path(), "--out", folder / "out", "--stride", "2", "--realtime", "--json"},
      disturbance);
  INFO(result.err);
  CHECK(result.code == 1);
  require_results(folder / "out");
}

TEST_CASE("a hangup that the caller has switched off does not end the run") {
  const TempFolder folder;
  Disturbance disturbance;
  disturbance.interrupt_on = "\"type\":\"progress\"";
  disturbance.signal = SIGHUP;
  disturbance.hangup_ignored = true;
  const ProgramResult result = run_replay(
      {rendered_sequence(), "--out", folder / "out", "--stride", "4", "--json"}, disturbance);
  INFO(result.err);
  CHECK(result.code == 0);
}

TEST_CASE("a reader that goes away costs no result") {
  const TempFolder folder;
  const std::string out = folder / "out";
  Disturbance disturbance;
  disturbance.reader = Reader::kGone;
  std::vector<std::string> run = {rendered_sequence(), "--out", out, "--stride", "4"};
  SECTION("of progress as JSON") { run.emplace_back("--json"); }
  SECTION("of progress for people") {}
  SECTION("of the summary") { run.emplace_back("--quiet"); }
  CHECK(run_replay(run, disturbance).code == 0);
  require_results(out);
}

TEST_CASE("a full device for progress and summary costs no result, but is said") {
  const TempFolder folder;
  const std::string out = folder / "out";
  Disturbance disturbance;
  disturbance.reader = Reader::kFullDevice;
  std::vector<std::string> run = arguments(rendered_sequence(), out);
  SECTION("JSON") { run.emplace_back("--json"); }
  SECTION("summary") {}
  const ProgramResult result = run_replay(run, disturbance);
  CHECK(result.code == 4);
  CHECK(has(result.err, "output lost: No space left on device"));
  require_results(out);
}

TEST_CASE("names that are not UTF-8 cost no result") {
  const TempFolder folder;
  const std::string sequence = folder / "M\xFCnchen";
  fs::copy(fs::path(rendered_sequence()) / "rgb", sequence);
  write_file(sequence + "/1000.5\xE4.png", "");
  const std::string out = folder / "out\xE4";
  const ProgramResult result = run_replay({sequence, "--out", out, "--stride", "4", "--json"});
  INFO(result.err);
  CHECK(result.code == 0);
  require_results(out);
  const std::string page = read_file(out + "/report.html");
  CHECK(unisim::tools::valid_utf8(page) == page);
  const nlohmann::json summary = nlohmann::json::parse(read_file(out + "/summary.json"));
  CHECK(has(summary.at("sequence").get<std::string>(), "M\xEF\xBF\xBDnchen"));
  CHECK(unisim::tools::valid_utf8(result.out) == result.out);
}

TEST_CASE("a folder that another run writes into is refused, a killed run does not block it") {
  const TempFolder folder;
  const std::string out = folder / "out";
  fs::create_directory(out);
  const int other = open(out.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  REQUIRE(flock(other, LOCK_EX | LOCK_NB) == 0);
  for (const std::string more : {"--no-report", "--force"}) {
    const ProgramResult result = run_replay(with(arguments(rendered_sequence(), out), {more}));
    INFO(result.err);
    CHECK(result.code == 2);
    CHECK(has(result.err, out + ": another run writes there"));
    CHECK(lines_in(result.err) == 1);
    CHECK(fs::is_empty(out));
  }
  close(other);
  write_file(out + "/.map.ply.123.part", "of a run that was killed");
  CHECK(run_replay(arguments(rendered_sequence(), out)).code == 0);
  CHECK_FALSE(fs::exists(out + "/.map.ply.123.part"));
}
