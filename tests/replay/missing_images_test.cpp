// SPDX-License-Identifier: MIT
// A recorded run needs its predictions and the list of its frames, not the images.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/replay/damaged_sequence.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;
namespace fs = std::filesystem;

namespace {

/// A sequence, a run of it with its predictions stored, and runs of these predictions.
class RecordedRun {
 public:
  DamagedSequence sequence;

  void record() { run("first", {"--record", folder_ / "predictions"}); }

  ProgramResult repeat() {
    return run("again", {"--predictor", "recorded", "--predictions", folder_ / "predictions"});
  }

  std::string first(const std::string& name) const { return read_file(folder_ / "first/" + name); }
  std::string again(const std::string& name) const { return read_file(folder_ / "again/" + name); }
  nlohmann::json summary(const std::string& which) const {
    return nlohmann::json::parse(read_file(folder_ / which + "/summary.json"));
  }

  void check_same_poses() const {
    for (const char* name :
         {"trajectory.tum", "trajectory_live.tum", "trajectory_frames.tum", "keyframes.csv"}) {
      INFO(name);
      CHECK(first(name) == again(name));
    }
  }

 private:
  ProgramResult run(const std::string& out, const std::vector<std::string>& more) {
    ProgramResult result = run_replay(with(
        with(arguments(sequence.path(), folder_ / out), {"--every-frame", "--no-report"}), more));
    INFO(result.err);
    REQUIRE(result.code == 0);
    return result;
  }

  TempFolder folder_;
};

double vertices(const std::string& ply) {
  const std::string before = "element vertex ";
  return std::stod(ply.substr(ply.find(before) + before.size()));
}

}  // namespace

TEST_CASE("a recorded run is repeated with its images, without them and with half of them") {
  RecordedRun run;
  run.record();
  const size_t frames = run.sequence.lines.size();

  SECTION("with all images the map is the same to the colours") {
    CHECK(run.repeat().err.empty());
    run.check_same_poses();
    CHECK(run.first("map.ply") == run.again("map.ply"));
  }
  // Colours say where a surface ends: without them a view is filled in otherwise.
  SECTION("with none the map has no colours") {
    fs::remove_all(run.sequence.path() + "/rgb");
    const ProgramResult result = run.repeat();
    run.check_same_poses();
    CHECK(has(result.err, "cannot be read"));
    CHECK(has(result.err, "more keyframes without an image"));
    CHECK(lines_in(result.err) == 6);
    CHECK(vertices(run.again("map.ply")) > 0.7 * vertices(run.first("map.ply")));
    CHECK(run.summary("again").at("frames") == frames);
    CHECK(run.summary("again").at("frames_bad") == 0);
  }
  SECTION("with half of them") {
    for (size_t k = 0; k < frames; k += 2) fs::remove(run.sequence.image(k));
    run.repeat();
    run.check_same_poses();
  }
}

TEST_CASE("an image that was bad when the run was recorded is bad again, there or not") {
  RecordedRun run;
  const size_t keyframe = 8;
  fs::resize_file(run.sequence.image(keyframe), 100);
  run.record();
  if (GENERATE(false, true)) fs::remove_all(run.sequence.path() + "/rgb");
  const ProgramResult result = run.repeat();
  run.check_same_poses();
  CHECK(has(result.err, fs::path(run.sequence.image(keyframe)).filename().string()));
  for (const char* count : {"frames", "frames_bad", "keyframes"}) {
    INFO(count);
    CHECK(run.summary("first").at(count) == run.summary("again").at(count));
  }
  CHECK(run.summary("again").at("frames_bad") == 1);
}
