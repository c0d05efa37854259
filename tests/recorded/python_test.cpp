// SPDX-License-Identifier: MIT
// Files go both ways between the library and tools/export/unisim_record.py.
#include <cmath>
#include <cstdlib>
#include <string>

#include "drivers/recorded/recorded.h"
#include "tests/recorded/transcript.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

std::string python() {
  const char* chosen = std::getenv("UNISIM_PYTHON");
  return chosen != nullptr ? chosen : UNISIM_PYTHON;
}

/// Runs Python with its output in `output`. @return exit status
int run_python(const std::string& arguments, const std::string& output) {
  const std::string command = "'" + python() + "' " + arguments + " > '" + output + "' 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool have_numpy(const TempFolder& folder) {
  if (run_python("-c 'import numpy'", folder.file("out")) == 0) return true;
  WARN("skipped: python3 with numpy is missing");
  return false;
}

const std::string kExport = UNISIM_EXPORT_FOLDER;

void take_keyframes(unisim_predictor* recorded, int count) {
  for (int id = 0; id < count; ++id) {
    unisim_frame frame{};
    frame.index = 10 * id;
    frame.timestamp_ns = 1000 * id;
    unisim_motion motion{};
    REQUIRE(recorded->observe(recorded, &frame, &motion) == UNISIM_PREDICTION_OK);
    CHECK(motion.keyframe_advice == 1);
    REQUIRE(recorded->keyframe(recorded, &frame, id) == UNISIM_PREDICTION_OK);
  }
}

float test_depth(int pixel) { return static_cast<float>(pixel) / 7.0F + 1.0F; }

}  // namespace

TEST_CASE("the library reads what Python wrote") {
  const TempFolder folder;
  if (!have_numpy(folder)) return;
  const std::string path = folder.file("python.usr");
  const std::string script = std::string(UNISIM_TEST_FOLDER) + "/write_predictions.py";
  const int status =
      run_python("'" + script + "' '" + kExport + "' '" + path + "'", folder.file("out"));
  INFO(read_bytes(folder.file("out")));
  REQUIRE(status == 0);

  char message[300];
  unisim_predictor* recorded = unisim_recorded_open(path.c_str(), message, sizeof message);
  INFO(message);
  REQUIRE(recorded != nullptr);
  CHECK(std::string(message).empty());
  take_keyframes(recorded, 3);

  unisim_pair_prediction pair{};
  REQUIRE(recorded->two_view(recorded, 0, 1, &pair) == UNISIM_PREDICTION_OK);
  CHECK(pair.T_i_j.q[1] == Approx(std::sin(0.125)).margin(1e-15));
  CHECK(pair.T_i_j.q[3] == Approx(std::cos(0.125)).margin(1e-15));
  CHECK(pair.T_i_j.t[0] == 0.5);
  CHECK(pair.T_i_j.s == 1.0);
  CHECK(pair.focal_px == 300.5);
  CHECK(pair.center_sigma == 0.125);
  REQUIRE(pair.depth_i.width == 5);
  REQUIRE(pair.depth_i.height == 3);
  CHECK(std::isnan(pair.depth_i.depth[1]));
  CHECK(pair.depth_i.depth[14] == test_depth(14));
  CHECK(pair.depth_i.confidence == nullptr);
  REQUIRE(pair.depth_j.confidence != nullptr);
  CHECK(pair.depth_j.confidence[7] == 3.0F);
  CHECK(pair.depth_j.depth[8] == 2.0F * test_depth(8));

  CHECK(recorded->two_view(recorded, 1, 2, &pair) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::string(recorded->message(recorded)) == "the network saw a wall");

  const int32_t ids[] = {0, 1, 2};
  unisim_window_prediction window{};
  CHECK(recorded->multi_view(recorded, ids, 3, &window) == UNISIM_PREDICTION_PENDING);
  unisim_frame frame{};
  frame.index = 30;
  frame.timestamp_ns = 3000;
  REQUIRE(recorded->keyframe(recorded, &frame, 3) == UNISIM_PREDICTION_OK);
  REQUIRE(recorded->multi_view(recorded, ids, 3, &window) == UNISIM_PREDICTION_OK);
  REQUIRE(window.count == 2);
  CHECK(window.keyframe_ids[1] == 2);
  CHECK(window.token == 77);
  CHECK(window.metres_per_unit == 2.5);
  CHECK(window.metres_sigma == 0.125);
  CHECK(window.metres_common_sigma == 0.0625);
  CHECK(std::abs(window.T_window_kf[0].q[1]) == Approx(std::sin(1.55)).margin(1e-15));
  CHECK(window.depth[1].depth[2] == test_depth(2) + 1.0F);

  REQUIRE(recorded->two_view(recorded, 2, 3, &pair) == UNISIM_PREDICTION_OK);
  CHECK(pair.depth_j.width == 300);
  recorded->destroy(recorded);
}

TEST_CASE("Python checks what the library wrote") {
  const TempFolder folder;
  if (!have_numpy(folder)) return;
  const std::string path = folder.file("library.usr");
  record_scripted(path);
  const std::string script = "'" + kExport + "/unisim_record.py' info '" + path + "'";
  REQUIRE(run_python(script, folder.file("out")) == 0);
  const std::string whole = read_bytes(folder.file("out"));
  INFO(whole);
  CHECK(whole.find("predictor scripted, images 640x480") != std::string::npos);
  CHECK(whole.find("keyframes: 12") != std::string::npos);
  CHECK(whole.find("complete, every checksum is right") != std::string::npos);

  std::string bytes = read_bytes(path);
  write_bytes(path, bytes.substr(0, bytes.size() - 100));
  CHECK(run_python(script, folder.file("out")) == 0);
  CHECK(read_bytes(folder.file("out")).find("cut off after byte") != std::string::npos);

  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_bytes(path, bytes);
  CHECK(run_python(script, folder.file("out")) == 3);
  CHECK(read_bytes(folder.file("out")).find("checksum") != std::string::npos);
}
