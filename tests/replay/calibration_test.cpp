// SPDX-License-Identifier: MIT
// --focal, --principal, --distortion and --calibration: taken where they fit, else one line.
#include <string>
#include <vector>

#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

std::string calibration(int width, int height) {
  return "image_width: " + std::to_string(width) + "\nimage_height: " + std::to_string(height) +
         "\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [524.8, 0, 300.0, 0, 524.8, 230.0, 0, 0, "
         "1]\n"
         "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
         "  data: [-0.1, 0.02, 0.001, 0.0, 0.0]\n";
}

/// The sequence's frames have 320x240 pixels.
ProgramResult run_with(const TempFolder& folder, std::vector<std::string> more) {
  std::vector<std::string> all = {rendered_sequence(), "--out",  folder / "out", "--stride", "4",
                                  "--quiet",           "--force"};
  all.insert(all.end(), more.begin(), more.end());
  return run_replay(all);
}

void check_refused(const ProgramResult& result, int code, const std::string& part) {
  INFO(result.err);
  CHECK(result.code == code);
  CHECK(has(result.err, part));
}

}  // namespace

TEST_CASE("a calibration is taken, scaled to the frames, and told as given") {
  const TempFolder folder;
  const std::string file = folder.write("camera.yaml", calibration(640, 480));
  const ProgramResult result = run_with(folder, {"--calibration", file});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const std::string summary = read_file(folder / "out/summary.json");
  CHECK(has(summary, "\"focal_px\": 262.4"));
  CHECK(has(summary, "\"intrinsics\": \"given\""));
}

TEST_CASE("the same camera by file and by options is the same configuration") {
  const TempFolder folder;
  const std::string file = folder.write("camera.yaml", calibration(640, 480));
  const ProgramResult by_file = run_replay({"x", "--calibration", file, "--print-config"});
  CHECK(has(by_file.out, "distortion_1 = -0.1"));
  CHECK(has(by_file.out, "calibrated_width = 640"));
  const std::string config = folder.write("run.toml", by_file.out);
  CHECK(run_replay({"x", "--config", config, "--print-config"}).out == by_file.out);
  const ProgramResult by_options =
      run_replay({"x", "--focal", "524.5", "--principal", "300,230", "--distortion",
                  "-0.125,0.02,0.001,0", "--print-config"});
  INFO(by_options.err);
  CHECK(has(by_options.out, "focal_px = 524.5"));
  CHECK(has(by_options.out, "principal_x_px = 300.0"));
  CHECK(has(by_options.out, "distortion_model = 1"));
  CHECK(has(by_options.out, "distortion_1 = -0.125"));
  CHECK(has(by_options.out, "distortion_3 = 0.001"));
}

TEST_CASE("a camera that does not fit the frames or the run is refused in one line") {
  const TempFolder folder;
  const std::string wide = folder.write("wide.yaml", calibration(640, 360));
  check_refused(run_with(folder, {"--calibration", wide}), 3, "640x360");
  check_refused(run_with(folder, {"--calibration", folder.write("bad.yaml", "hello")}), 3,
                "bad.yaml");
  check_refused(run_with(folder, {"--calibration", folder / "none.yaml"}), 3, "none.yaml");
  check_refused(run_with(folder, {"--principal", "400,100"}), 3, "principal");
  check_refused(run_with(folder, {"--principal", "160"}), 2, "--principal");
  check_refused(run_with(folder, {"--principal", "nan,100"}), 2, "--principal");
  check_refused(run_with(folder, {"--distortion", "-0.1,0.02"}), 2, "--focal");
  check_refused(run_with(folder, {"--focal", "260", "--distortion", "-0.1,0.02,0"}), 2,
                "--distortion");
  check_refused(run_with(folder, {"--calibration", wide, "--focal", "260"}), 2, "--calibration");
  check_refused(
      run_with(folder, {"--principal", "160,120", "--predictor", "recorded", "--predictions", "x"}),
      2, "--predictor geometric");
}
