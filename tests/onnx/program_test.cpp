// SPDX-License-Identifier: MIT
// Whole runs: rendered pixels through ONNX Runtime to a trajectory.
#include "tests/replay/program.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/onnx/predictor_fixture.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;
namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

/// The rendered walk, about 8 m long; lengths in metres ("0") or in a unit that changes ("0.3").
std::string sequence(const std::string& spread) { return UNISIM_RENDERED "/spread-" + spread; }

Words arguments(const std::string& spread, const std::string& out, const Words& more) {
  Words words = {sequence(spread), "--out", out, "--stride", "2", "--no-report", "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words decoder(const std::string& name = "decoder.onnx") {
  return {"--predictor", "onnx", "--model", model_file(name), "--threads", "1"};
}

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

nlohmann::json summary(const std::string& out) {
  return nlohmann::json::parse(read_file(out + "/summary.json"));
}

/// A run that must succeed. @return its summary
nlohmann::json run(const std::string& spread, const std::string& out, const Words& more) {
  const ProgramResult result = run_replay(arguments(spread, out, more));
  INFO(result.err);
  REQUIRE(result.code == 0);
  return summary(out);
}

double path_length(const std::string& trajectory) {
  std::istringstream text(read_file(trajectory));
  double length = 0;
  double last[3] = {};
  bool first = true;
  for (std::string line; std::getline(text, line);) {
    double time = 0;
    double t[3] = {};
    if (std::sscanf(line.c_str(), "%lf %lf %lf %lf", &time, &t[0], &t[1], &t[2]) != 4) continue;
    if (!first) length += std::hypot(t[0] - last[0], t[1] - last[1], t[2] - last[2]);
    first = false;
    std::copy(t, t + 3, last);
  }
  return length;
}

const Words kResults = {"trajectory.tum", "trajectory_live.tum", "keyframes.csv", "map.ply"};

void require_same_bytes(const std::string& a, const std::string& b) {
  for (const std::string& name : kResults) {
    INFO(name);
    const std::string first = read_file((fs::path(a) / name).string());
    CHECK(first == read_file((fs::path(b) / name).string()));
    CHECK_FALSE(first.empty());
  }
}

}  // namespace

TEST_CASE("pixels become a trajectory that is right to a ten-thousandth of the path") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const nlohmann::json figures = run("0", folder / "out", decoder());
  const double path = path_length(sequence("0") + "/groundtruth.txt");
  CHECK(path > 5);
  CHECK(figures["keyframes"] == 75);
  CHECK(figures["submaps"] > 3);
  CHECK(figures["coverage"] == 1.0);
  CHECK(figures["ate_rmse_m"] < 1e-4 * path);
  CHECK(figures["ate_live_rmse_m"] < 1e-4 * path);
  CHECK(figures["focal_px"] == Approx(0.82 * 64).epsilon(1e-4));
  CHECK(figures["memory"]["heap_calls_after_init"] == 0);
  std::printf("ATE %.2e m on a path of %.2f m\n", figures["ate_rmse_m"].get<double>(), path);
}

TEST_CASE("with a unit for each inference only the consistent graph stays exact") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  write_file(folder / "paper.toml", "[session]\npreset = 1\n");
  const nlohmann::json consistent = run("0.3", folder / "consistent", decoder());
  const nlohmann::json paper =
      run("0.3", folder / "paper", with(decoder(), {"--config", folder / "paper.toml"}));
  const double ours = consistent["ate_rmse_m"];
  const double printed = paper["ate_rmse_m"];
  CHECK(ours < 1e-4 * path_length(sequence("0.3") + "/groundtruth.txt"));
  CHECK(ours < 0.05 * printed);
  std::printf("units spread by 30 %%: ATE %.2e m consistent, %.2e m paper\n", ours, printed);
}

TEST_CASE("a run repeats bit for bit, and so does its recording") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const std::string file = folder / "predictions";
  run("0.3", folder / "first", with(decoder(), {"--record", file}));
  run("0.3", folder / "second", decoder());
  run("0.3", folder / "recorded", {"--predictor", "recorded", "--predictions", file});
  require_same_bytes(folder / "first", folder / "second");
  require_same_bytes(folder / "first", folder / "recorded");
}

TEST_CASE("a model in two files gives the trajectory of the one file, byte for byte") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  run("0.3", folder / "whole", decoder());
  run("0.3", folder / "split", decoder("decoder_split.onnx"));
  require_same_bytes(folder / "whole", folder / "split");
}

TEST_CASE("a recording is asked for the windows it holds, whatever their size was") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const std::string file = folder / "predictions";
  run("0.3", folder / "first",
      with(decoder(), {"--window", "9", "--overlap", "3", "--record", file}));
  run("0.3", folder / "recorded", {"--predictor", "recorded", "--predictions", file});
  require_same_bytes(folder / "first", folder / "recorded");
}

TEST_CASE("a model that returns NaN once in a while costs these keyframes, no more") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const ProgramResult result =
      run_replay(arguments("0", folder / "out", decoder("decoder_nan.onnx")));
  INFO(result.err);
  REQUIRE(result.code == 0);
  CHECK(has(result.err, "depth of view 0 is not finite"));
  // Column 4 is the state: 2 is DEGRADED, and TRACKING (1) comes back after each.
  std::istringstream table(read_file((folder / "out") + "/keyframes.csv"));
  int degraded = 0;
  int resumed = 0;
  std::string last;
  for (std::string line; std::getline(table, line);) {
    std::istringstream row(line);
    std::string cell;
    for (int column = 0; column < 4; ++column) std::getline(row, cell, ',');
    if (cell == "degraded") ++degraded;
    if (last == "degraded" && cell == "tracking") ++resumed;
    last = cell;
  }
  CHECK(degraded > 0);
  CHECK(resumed > 0);
  CHECK(last == "tracking");
}

TEST_CASE("images that upset a model are left out of their windows, and the map stays one") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  // One image in ten or in fifty makes all of its inference NaN, or one in ten only when it is the
  // first view. The pairs around it are lost; the window over the gap joins the map again.
  for (const char* model : {"decoder_nan_any.onnx", "decoder_nan_rare.onnx", "decoder_nan.onnx"}) {
    const TempFolder folder;
    const Words every_frame = {sequence("0.3"), "--out",  folder / "out", "--stride", "1",
                               "--no-report",   "--quiet"};
    const ProgramResult result = run_replay(with(every_frame, decoder(model)));
    INFO(model << "\n" << result.err);
    REQUIRE(result.code == 0);
    const nlohmann::json figures = summary(folder / "out");
    CHECK(figures["keyframes"] == 150);
    CHECK(figures["pairs_refused"] > 0);
    CHECK(figures["segments"] == 1);
    CHECK(figures["submaps_refused"] == 0);
    CHECK(figures["coverage"] > 0.9);
    CHECK(figures["ate_rmse_m"] < 1e-4 * path_length(sequence("0.3") + "/groundtruth.txt"));
    CHECK(has(result.err, ": taken without "));
  }
}

TEST_CASE("a run with windows taken in part is recorded and repeats bit for bit") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const std::string file = folder / "predictions";
  run("0.3", folder / "first", with(decoder("decoder_nan_any.onnx"), {"--record", file}));
  run("0.3", folder / "recorded", {"--predictor", "recorded", "--predictions", file});
  require_same_bytes(folder / "first", folder / "recorded");
}

TEST_CASE("windows are made smaller where the model takes no more views, in one line") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const ProgramResult result =
      run_replay(arguments("0", folder / "out",
                           {"--predictor", "onnx", "--model-2v", model_file("decoder.onnx"),
                            "--model-mv", model_file("eight_views.onnx")}));
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(has(result.err, "windows have 8 keyframes in place of 16"));
  CHECK(has(result.err, "licence: MIT"));
}

TEST_CASE("the oldest ONNX Runtime that is supported gives the same trajectory") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  if (!fs::exists(UNISIM_OLDEST_RUNTIME)) {
    WARN("skipped: no " UNISIM_OLDEST_RUNTIME " (tools/fetch_onnxruntime.sh 1.21.0)");
    return;
  }
  const TempFolder folder;
  const nlohmann::json figures =
      run("0.3", folder / "old", with(decoder(), {"--onnx-runtime", UNISIM_OLDEST_RUNTIME}));
  CHECK(figures["ate_rmse_m"] < 1e-4 * path_length(sequence("0.3") + "/groundtruth.txt"));
}

TEST_CASE("options and exit codes") {
  const TempFolder folder;
  const auto code = [&](const Words& more) {
    const ProgramResult result = run_replay(arguments("0", folder / "out", more));
    INFO(result.err);
    CHECK(result.err.find("unisim-replay: ") == 0);
    return result.code;
  };
  CHECK(code({"--predictor", "onnx"}) == 2);
  CHECK(code({"--predictor", "onnx", "--model-2v", model_file("pair.onnx")}) == 2);
  CHECK(code({"--model", model_file("decoder.onnx")}) == 2);
  CHECK(code({"--model-encoder", model_file("split.encoder.onnx")}) == 2);
  CHECK(code(with(decoder(), {"--onnx-runtime", "/nowhere.so"})) == 4);
  if (!missing_runtime().empty()) return;
  CHECK(code(with(decoder(), {"--provider", "nonesuch"})) == 4);
  CHECK(code(decoder("no_metadata.onnx")) == 3);
  CHECK(code(decoder("split_pair.onnx")) == 3);
  CHECK(code(with(decoder(), {"--model-encoder", model_file("split.encoder.onnx")})) == 2);
}

TEST_CASE("time to load the tiny model and predict once") {
  // Before the library is opened for the first time, where this test runs by itself as under CTest.
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_model("decoder.onnx");
  REQUIRE(opened.predictor != nullptr);
  add_keyframes(opened.predictor.get(), {colourful(64, 48, 0), colourful(64, 48, 1)});
  unisim_pair_prediction pair{};
  opened.predictor->two_view(opened.predictor.get(), 0, 1, &pair);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  const double cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  std::printf("load, warm-up and first inference: %.1f ms, %.1f of processor (150 are wanted)\n",
              spent.count(), cpu_ms);
  CHECK(spent.count() < 5000);
}
