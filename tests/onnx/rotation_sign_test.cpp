// SPDX-License-Identifier: MIT
// A rotation is two quaternions; predictions have the one that recorded files have, w >= 0.
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "tests/onnx/predictor_fixture.hpp"
#include "tests/replay/program.hpp"

using namespace unisim::testing;

TEST_CASE("the quaternions of a trajectory do not change sign between neighbours") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const std::string out = folder / "out";
  const ProgramResult result = run_replay(
      {UNISIM_RENDERED "/spread-0", "--out", out, "--stride", "2", "--no-report", "--quiet",
       "--predictor", "onnx", "--model", model_file("decoder.onnx"), "--threads", "1"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  std::istringstream lines(read_file(out + "/trajectory.tum"));
  double last[4] = {};
  int32_t poses = 0;
  for (std::string line; std::getline(lines, line);) {
    double q[4] = {};
    if (std::sscanf(line.c_str(), "%*f %*f %*f %*f %lf %lf %lf %lf", &q[0], &q[1], &q[2], &q[3]) !=
        4) {
      continue;
    }
    INFO("pose " << poses);
    CHECK(q[0] * last[0] + q[1] * last[1] + q[2] * last[2] + q[3] * last[3] >= 0);
    std::copy(q, q + 4, last);
    ++poses;
  }
  CHECK(poses == 75);
}
