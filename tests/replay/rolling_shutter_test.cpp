// SPDX-License-Identifier: MIT
// --rolling-shutter and --readout-ms: rows that are read one after the other.
#include <nlohmann/json.hpp>

#include "tests/replay/program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

struct Outcome {
  double ate_m;
  double readout_ms;
};

Outcome run_with(const std::vector<std::string>& options) {
  const TempFolder folder;
  std::vector<std::string> all = {rolling_sequence(), "--out", folder / "out", "--quiet"};
  all.insert(all.end(), options.begin(), options.end());
  const ProgramResult result = run_replay(all);
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto summary = nlohmann::json::parse(read_file(folder / "out" + "/summary.json"));
  return {summary["ate_rmse_m"].get<double>(), summary["readout_ms"].get<double>()};
}

}  // namespace

TEST_CASE("the readout of a rolling shutter is found, and the path with it is better") {
  const Outcome without = run_with({});
  CHECK(without.readout_ms == 0);
  const Outcome estimated = run_with({"--rolling-shutter"});
  CHECK(estimated.readout_ms == Approx(25).margin(3));
  CHECK(estimated.ate_m < 0.6 * without.ate_m);
  const Outcome given = run_with({"--readout-ms", "25"});
  CHECK(given.readout_ms == 25);
  CHECK(given.ate_m < 0.6 * without.ate_m);
}

TEST_CASE("a rolling shutter of nothing, and one for a network, are refused") {
  const TempFolder folder;
  const auto refuse = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {rolling_sequence(), "--out", folder / "out"});
    const ProgramResult result = run_replay(options);
    CHECK(result.code == 2);
    CHECK(has(result.err, "--readout-ms"));
  };
  refuse({"--readout-ms", "0"});
  refuse({"--rolling-shutter", "--predictor", "recorded", "--predictions", "x"});
}
