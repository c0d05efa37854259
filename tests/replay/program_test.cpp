// SPDX-License-Identifier: MIT
// unisim-replay as a user meets it: files, figures, exit codes.
#include "tests/replay/program.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/replay/damaged_sequence.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;
namespace fs = std::filesystem;

namespace {

/// One clear line and nothing else.
void require_failure(const ProgramResult& result, int code, const std::string& part) {
  INFO(result.err);
  CHECK(result.code == code);
  CHECK(has(result.err, part));
  CHECK(lines_in(result.err) == 1);
  CHECK(result.err.rfind("unisim-replay: ", 0) == 0);
}

}  // namespace

TEST_CASE("bad usage is one line and exit code 2") {
  const TempFolder folder;
  const std::string out = folder / "out";
  require_failure(run_replay({}), 2, "SEQUENCE is missing");
  require_failure(run_replay({"somewhere"}), 2, "--out is missing");
  require_failure(run_replay({"somewhere", "--out", out, "--sride", "5"}), 2, "--sride");
  require_failure(run_replay({"somewhere", "--out", out, "--stride", "0"}), 2, "--stride");
  require_failure(run_replay({"s", "--out", out, "--from", "5", "--to", "5"}), 2, "--to");
  require_failure(run_replay({"s", "--out", out, "--predictor", "recorded"}), 2, "--predictions");
}

TEST_CASE("a number on the command line is decimal and in its range") {
  const auto refused = [](const std::string& option, const std::string& value,
                          const std::string& range) {
    INFO(option << " " << value);
    require_failure(run_replay({"somewhere", "--out", "o", option, value}), 2,
                    option + ": '" + value + "' is not " + range);
  };
  for (const char* value : {"nan", "inf", "-5", "0", "1e300", "five", "0x10"}) {
    refused("--focal", value, "a number above 0 and up to 1e+06");
  }
  for (const char* value : {"0", "-1", "1.5", "99999999999999999999", "nan", "0x10", "5 "}) {
    refused("--stride", value, "a whole number from 1 to 1000000");
  }
  refused("--from", "-1", "a whole number from 0 to 10000000000");
  refused("--to", "1e9", "a whole number from 0 to 10000000000");
  refused("--window", "1", "a whole number from 2 to 64");
  refused("--overlap", "64", "a whole number from 0 to 63");
  refused("--threads", "257", "a whole number from 1 to 256");
  refused("--model-memory", "0", "a whole number from 1 to 100000000");
  CHECK(has(run_replay({"--print-config", "--stride", "010"}).out, "stride = 10\n"));
}

TEST_CASE("input that is not a sequence is one line and exit code 3") {
  const TempFolder folder;
  const std::string out = folder / "out";
  fs::create_directory(folder / "empty");
  write_file(folder / "notes.txt", "no images here\n");
  require_failure(run_replay(arguments(folder / "missing", out)), 3, folder / "missing");
  require_failure(run_replay(arguments(folder / "empty", out)), 3, folder / "empty");
  require_failure(run_replay(arguments(folder / "notes.txt", out)), 3, folder / "notes.txt");
}

TEST_CASE("a folder that cannot be written is known before the work starts") {
  const TempFolder folder;
  write_file(folder / "file", "");
  require_failure(run_replay(arguments(rendered_sequence(), folder / "file")), 3, "not a folder");
  require_failure(run_replay(arguments(rendered_sequence(), "/dev/full")), 3, "not a folder");
  require_failure(run_replay(arguments(rendered_sequence(), "/proc/unisim/out")), 3,
                  "cannot be written");
}

TEST_CASE("a configuration file is checked key by key") {
  const TempFolder folder;
  const std::string file = folder / "run.toml";
  const auto run = [&](const std::string& text) {
    write_file(file, text);
    return run_replay({"somewhere", "--out", folder / "out", "--config", file});
  };
  require_failure(run("[session]\nwindow_sise = 8\n"), 2, "did you mean session.window_size?");
  require_failure(run("[sesion]\nwindow_size = 8\n"), 2, "did you mean session.window_size?");
  require_failure(run("[session]\nwindow_size = \"8\"\n"), 2, "must be a whole number");
  require_failure(run("[pipeline]\nrealtime = 1\n"), 2, "must be true or false");
  require_failure(
      run("[session]\nwindow_size = 8000000000\n"), 2,
      "run.toml:2: session.window_size is 8000000000, must be a whole number from 2 to");
  require_failure(run("[session]\nhuber_delta = nan\n"), 2,
                  "run.toml:2: session.huber_delta is nan, must be a number above 0");
  require_failure(run("[session]\nwindow_size = 4\nwindow_overlap = 4\n"), 2,
                  "session.window_overlap (--overlap) is 4, must be less than");
  require_failure(run("[session]\nwindow_submaps = 2\nmax_keyframes = 100\n"), 2,
                  "session.max_keyframes is 100, must be at least 176");
  require_failure(run("[pipeline]\nmin_gap = 8\nmax_gap = 4\n"), 2, "pipeline.max_gap is 4");
  require_failure(run("[session\n"), 2, "run.toml:1");
  require_failure(run_replay({"s", "--out", "o", "--config", folder.path()}), 2,
                  folder.path() + ": a folder where a text file is expected");
  require_failure(run_replay({"s", "--out", "o", "--config", folder / "none.toml"}), 3,
                  "none.toml");
}

TEST_CASE("the printed configuration can be read back and says the same") {
  const TempFolder folder;
  const ProgramResult first = run_replay({"--print-config", "--window", "12", "--stride", "3"});
  CHECK(first.code == 0);
  CHECK(has(first.out, "window_size = 12"));
  CHECK(has(first.out, "stride = 3"));
  write_file(folder / "run.toml", first.out);
  const ProgramResult second = run_replay({"--print-config", "--config", folder / "run.toml"});
  CHECK(second.code == 0);
  CHECK(second.out == first.out);
}

TEST_CASE("the window slides unless a batch is asked for") {
  CHECK(has(run_replay({"--print-config"}).out, "window_submaps = 24"));
  CHECK(has(run_replay({"--print-config", "--batch"}).out, "window_submaps = 0"));
}

TEST_CASE("a rendered sequence gives a trajectory, its figures and the same bytes each time") {
  const TempFolder folder;
  const std::string out = folder / "first";
  const ProgramResult result = run_replay(
      with(arguments(rendered_sequence(), out), {"--every-frame", "--record", folder / "record"}));
  INFO(result.err);
  REQUIRE(result.code == 0);
  const nlohmann::json summary = nlohmann::json::parse(read_file(out + "/summary.json"));
  CHECK(summary.at("schema") == 1);
  CHECK(summary.at("format") == "tum");
  CHECK(summary.at("frames") == 80);
  CHECK(summary.at("keyframes") == 20);
  CHECK(summary.at("coverage") >= 0.95);
  CHECK(summary.at("ate_rmse_m") < 0.05);
  CHECK(summary.at("ate_live_rmse_m") < 0.1);
  CHECK(summary.at("protocol").at("associated") == 20);
  CHECK(summary.at("timing_ms").at("track_total").at("n") == 20);
  CHECK(summary.at("memory").at("heap_calls_after_init") == 0);
  CHECK(poses_in(out + "/trajectory.tum") == 20);
  CHECK(poses_in(out + "/trajectory_frames.tum") > 60);
  CHECK(lines_in(read_file(out + "/keyframes.csv")) == 21);

  SECTION("a second run writes the same bytes") {
    const std::string again = folder / "second";
    REQUIRE(run_replay(with(arguments(rendered_sequence(), again), {"--every-frame"})).code == 0);
    for (const char* name :
         {"trajectory.tum", "trajectory_live.tum", "trajectory_frames.tum", "keyframes.csv"}) {
      CHECK(read_file(out + "/" + name) == read_file(again + "/" + name));
    }
  }
  SECTION("the recording gives the same bytes without a predictor") {
    const std::string again = folder / "recorded";
    REQUIRE(run_replay(with(arguments(rendered_sequence(), again),
                            {"--predictor", "recorded", "--predictions", folder / "record"}))
                .code == 0);
    CHECK(read_file(out + "/trajectory.tum") == read_file(again + "/trajectory.tum"));
  }
  SECTION("results are not overwritten without being asked to") {
    require_failure(run_replay(arguments(rendered_sequence(), out)), 2, "--force");
    CHECK(run_replay(with(arguments(rendered_sequence(), out), {"--force"})).code == 0);
  }
}

TEST_CASE("damaged frames are told and survived") {
  DamagedSequence sequence;
  const TempFolder folder;
  std::string told;
  SECTION("truncated image") {
    fs::resize_file(sequence.image(30), 900);
    told = fs::path(sequence.image(30)).filename().string();
  }
  SECTION("empty image") {
    fs::resize_file(sequence.image(30), 0);
    told = fs::path(sequence.image(30)).filename().string();
  }
  SECTION("missing image") {
    fs::remove(sequence.image(30));
    told = fs::path(sequence.image(30)).filename().string();
  }
  SECTION("image of another size") {
    const fs::path small = fs::path(small_sequence()) / "rgb";
    fs::copy_file(fs::directory_iterator(small)->path(), sequence.image(30),
                  fs::copy_options::overwrite_existing);
    told = "160x120";
  }
  const ProgramResult result = run_replay(arguments(sequence.path(), folder / "out"));
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(has(result.err, told));
  const nlohmann::json summary =
      nlohmann::json::parse(read_file((folder / "out") + "/summary.json"));
  CHECK(summary.at("frames") == 79);
  CHECK(summary.at("frames_bad") == 1);
  CHECK(summary.at("coverage") >= 0.95);
}

TEST_CASE("an image with the time of another is told and left out") {
  DamagedSequence sequence;
  const TempFolder folder;
  sequence.set_time(30, sequence.time(GENERATE(20, 29)));
  sequence.save_list();
  const ProgramResult result = run_replay(arguments(sequence.path(), folder / "out"));
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(has(result.err, "rgb.txt: 1 of 80 images have the time of another"));
  const nlohmann::json summary =
      nlohmann::json::parse(read_file((folder / "out") + "/summary.json"));
  CHECK(summary.at("frames") == 79);
  CHECK(summary.at("frames_bad") == 0);
  CHECK(summary.at("coverage") >= 0.95);
}

TEST_CASE("a sequence of damaged images only is bad input") {
  DamagedSequence sequence;
  const TempFolder folder;
  for (size_t k = 0; k < sequence.lines.size(); ++k) fs::resize_file(sequence.image(k), 100);
  const ProgramResult result = run_replay(arguments(sequence.path(), folder / "out"));
  CHECK(result.code == 3);
  CHECK(has(result.err, "no readable frame"));
}

TEST_CASE("ground truth of another time base costs the score, not the results") {
  const TempFolder folder;
  write_file(folder / "truth.txt",
             "90000.0 0 0 0 0 0 0 1\n90001.0 1 0 0 0 0 0 1\n90002.0 1 1 0 0 0 0 1\n");
  const std::string out = folder / "out";
  const ProgramResult result = run_replay(
      with(arguments(rendered_sequence(), out), {"--ground-truth", folder / "truth.txt"}));
  INFO(result.err);
  CHECK(result.code == 0);
  CHECK(lines_in(result.err) == 1);
  CHECK(has(result.err, "truth.txt has times 90000.000 to 90002.000 s, the sequence 1000.000"));
  CHECK(poses_in(out + "/trajectory.tum") == 20);
  const nlohmann::json summary = nlohmann::json::parse(read_file(out + "/summary.json"));
  CHECK(summary.at("ate_rmse_m").is_null());
  CHECK(has(summary.at("score_problem"), "same clock"));
}

TEST_CASE("ground truth that cannot be read is known before the work starts") {
  const TempFolder folder;
  write_file(folder / "truth.txt", "not a trajectory\n");
  write_file(folder / "kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n");
  for (const std::string& truth :
       {folder / "truth.txt", folder / "none.txt", folder / "kitti.txt"}) {
    const ProgramResult result =
        run_replay(with(arguments(rendered_sequence(), folder / "out"), {"--ground-truth", truth}));
    require_failure(result, 3, truth);
    CHECK_FALSE(fs::exists((folder / "out") + "/trajectory.tum"));
  }
}

TEST_CASE("a camera that does not move gives no trajectory") {
  DamagedSequence sequence;
  const TempFolder folder;
  const std::string still = read_file(sequence.image(0));
  for (size_t k = 1; k < sequence.lines.size(); ++k) write_file(sequence.image(k), still);
  const ProgramResult result = run_replay(arguments(sequence.path(), folder / "out"));
  INFO(result.err);
  CHECK(result.code == 3);
  CHECK(has(result.err, "not enough motion"));
  CHECK_FALSE(fs::exists((folder / "out") + "/trajectory.tum"));
}

TEST_CASE("a bounded run that the session has forgotten in part writes every keyframe") {
  const TempFolder folder;
  const std::string out = folder / "out";
  write_file(folder / "run.toml",
             "[session]\nwindow_size = 3\nwindow_overlap = 1\nwindow_submaps = 2\n"
             "max_keyframes = 33\n");
  const ProgramResult result =
      run_replay({rendered_sequence(), "--out", out, "--stride", "2", "--quiet", "--every-frame",
                  "--no-report", "--config", folder / "run.toml"});
  INFO(result.err);
  REQUIRE(result.code == 0);
  const nlohmann::json summary = nlohmann::json::parse(read_file(out + "/summary.json"));
  CHECK(summary.at("keyframes") == 40);
  CHECK(summary.at("coverage") == 1.0);
  CHECK(summary.at("ate_rmse_m") < 0.05);
  CHECK(poses_in(out + "/trajectory.tum") == 40);
  CHECK(poses_in(out + "/trajectory_frames.tum") > 60);
  CHECK(lines_in(read_file(out + "/keyframes.csv")) == 41);
}

TEST_CASE("a full disk is one line per file that is missing, no file is half there") {
  const TempFolder folder;
  const std::string out = folder / "out";
  Disturbance disturbance;
  disturbance.max_file_bytes = 1000;
  const ProgramResult result =
      run_replay(with(arguments(rendered_sequence(), out), {"--no-report"}), disturbance);
  INFO(result.err);
  CHECK(result.code == 4);
  CHECK(has(result.err, "trajectory.tum: File too large"));
  for (const fs::directory_entry& entry : fs::directory_iterator(out)) {
    INFO(entry.path());
    CHECK(entry.path().extension() != ".part");
    CHECK(entry.path().filename() != "trajectory.tum");
  }
}
