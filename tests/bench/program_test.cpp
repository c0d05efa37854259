// SPDX-License-Identifier: MIT
// unisim-bench as a program: result lines, exit codes, one line on stderr.
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/catch.hpp"
#include "tests/support/program_in_folder.hpp"

namespace {

using Json = nlohmann::json;

constexpr const char* kTriangle =
    "node 0 T 1 0 0 0 1 0 0 0 1\n"
    "node 1 T 0 0 0 0 1 1 0.5 0 1\n"
    "node 2 T 0 0 0 0 1 2 0.5 0 1\n"
    "edge v2v 0 1 1 0 0 0 0 1 1 0 0 1\n"
    "edge v2v 1 2 1 0 0 0 0 1 1 0 0 1\n"
    "edge v2v 0 2 1 0 0 0 0 1 2.1 0 0 1\n";

class Program : public ProgramInFolder {
 public:
  Program() : ProgramInFolder(UNISIM_BENCH_PROGRAM) { folder().write("graph.usg", kTriangle); }
};

void require_times(const Json& times) {
  CHECK(times.at("p50").get<double>() <= times.at("p95").get<double>());
  CHECK(times.at("p95").get<double>() <= times.at("max").get<double>());
}

}  // namespace

TEST_CASE("solver prints one result line per run") {
  Program program;
  REQUIRE(program.run("solver graph.usg --repeat 3 --json") == 0);
  std::istringstream lines(program.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const Json result = Json::parse(line);
    for (const char* key : {"config", "iterations", "setup_ms", "solve_ms", "rss_before_kb",
                            "rss_peak_kb", "alloc_bytes"}) {
      INFO(key);
      CHECK(result.contains(key));
    }
    CHECK(result.at("solver") == "unisim");
    CHECK(result.at("graph") == "graph.usg");
    CHECK(result.at("nodes") == 3);
    CHECK(result.at("edges") == 3);
    CHECK(result.at("allocs") == 0);
    // Residuals (0, 0.5), (0, 0) and (-0.1, 0.5): (0.25 + 0 + 0.26) / 2.
    CHECK(result.at("cost0").get<double>() == Approx(0.255));
    // The chain is 0.1 short: shared evenly by three edges that is 0.01 / 6, and scale may help.
    CHECK(result.at("cost").get<double>() < 0.01 / 6.0);
    CHECK(result.at("cost").get<double>() > 0.0);
    CHECK(result.at("trace").front().size() == 2);
    for (const char* phase : {"linearise", "assemble", "order", "analyse", "factor", "solve"}) {
      CHECK(result.at("split_ms").contains(phase));
    }
  }
  CHECK(count == 3);
}

TEST_CASE("solver prints a table without --json") {
  Program program;
  REQUIRE(program.run("solver graph.usg") == 0);
  CHECK(program.out.find("solve_ms") != std::string::npos);
  CHECK(program.out.find('{') == std::string::npos);
}

TEST_CASE("window prints memory, times and errors") {
  Program program;
  REQUIRE(program.run("window --keyframes 60 --world scan --json") == 0);
  const Json result = Json::parse(program.out);
  CHECK(result.at("keyframes") == 60);
  CHECK(result.at("arena_bytes").get<int64_t>() > 0);
  CHECK(result.at("heap_calls_after_init") == 0);
  require_times(result.at("update_ms"));
  require_times(result.at("loop_update_ms"));
  CHECK(result.at("snapshot_bytes").get<int64_t>() > 0);
  CHECK(result.at("snapshot_bytes") < result.at("arena_bytes"));
  CHECK(result.at("save_ms").get<double>() >= 0.0);
  CHECK(result.at("load_ms").get<double>() >= 0.0);
  CHECK(result.at("ate_m").get<double>() > 0.0);
  CHECK(result.at("ate_over_batch").get<double>() > 0.0);
  REQUIRE(program.run("window --keyframes 60 --batch off --skeleton-capacity 8 --json") == 0);
  CHECK(Json::parse(program.out).at("ate_over_batch").is_null());
  CHECK(Json::parse(program.out).at("skeleton_capacity") == 8);
}

TEST_CASE("depth prints the time of a ratio by size") {
  Program program;
  REQUIRE(program.run("depth --repeat 1 --json") == 0);
  const Json sizes = Json::parse(program.out).at("depth_ratio");
  REQUIRE(sizes.size() > 3);
  CHECK(sizes.front().at("ms").get<double>() < sizes.back().at("ms").get<double>());
}

TEST_CASE("lanes prints the live pose beside slow windows and beside instant ones") {
  Program program;
  REQUIRE(program.run("lanes --repeat 1 --keyframes 32 --pair-ms 1 --window-s 0.2 --json") == 0);
  const Json result = Json::parse(program.out);
  CHECK(result.at("p95_over_instant").get<double>() > 0.0);
  REQUIRE(result.at("runs").size() == 1);
  for (const char* run : {"instant", "slow"}) {
    const Json times = result.at("runs").front().at(run);
    CHECK(times.at("p50_ms").get<double>() >= 1.0);
    CHECK(times.at("p50_ms").get<double>() <= times.at("p95_ms").get<double>());
    CHECK(times.at("windows_dropped") == 0);
  }
}

TEST_CASE("covariance prints the times of one pose and of all, and what it read") {
  Program program;
  program.folder().write("triangle.usg",
                         "node 0 T 1 0 0 0 1 0 0 0 1\nnode 1 T 0 0 0 0 1 0 0 0 1\n"
                         "node 2 T 0 0 0 0 1 0 0 0 1\nedge v2v 0 1 1 0 0 0 0 1 0 0 0 1\n"
                         "edge v2v 1 2 1 0 0 0 0 1 0 0 0 1\nedge v2v 0 2 1 0 0 0 0 1 0 0 0 1\n");
  REQUIRE(program.run("covariance triangle.usg --repeat 2 --json") == 0);
  const Json result = Json::parse(program.out);
  CHECK(result.at("poses") == 2);
  CHECK(result.at("heap_calls") == 0);
  for (const char* key : {"first_ms", "another_ms", "all_ms"}) {
    INFO(key);
    CHECK(result.at(key).at("n") == 2);
    require_times(result.at(key));
  }
  // All in one place nothing mixes: one edge beside two in a row has variance 2/3 in each
  // direction.
  CHECK(result.at("trace_sum").get<double>() == Approx(2.0 * 7.0 * 2.0 / 3.0));
}

TEST_CASE("unisim-bench says in one line what is wrong") {
  Program program;
  program.require_failure("", 2, "subcommand");
  program.require_failure("solver", 2, "graph");
  program.require_failure("solver graph.usg --repeat 0", 2, "--repeat");
  program.require_failure("lanes --window-s -1", 2, "--window-s");
  program.require_failure("solver missing.usg", 3, "missing.usg");
  program.require_failure("window", 2, "--keyframes");
  program.require_failure("window --keyframes 10", 2, "--keyframes");
  program.require_failure("window --keyframes 60 --loops maybe", 2, "--loops");
  program.require_failure("window --keyframes 60 --seed -1", 2, "--seed");
  program.require_failure("window --keyframes 60 --false-loops nan", 2, "a number from 0 to 0.9");
  program.require_failure("window --keyframes 60 --window-submaps -1", 2, "from 2 to 64, or 0");
  program.require_failure("window --keyframes 60 --skeleton-capacity 7", 2,
                          "from 8 to 65536, or 0");
  program.require_failure("solver graph.usg --initial-lambda inf", 2, "--initial-lambda");
  program.folder().write("loose.usg",
                         "node 0 T 0 0 0 0 1 0 0 0 1\nnode 1 T 1 0 0 0 1 0 0 0 1\n"
                         "node 2 T 0 0 0 0 1 0 0 0 1\nedge v2v 0 1 1 0 0 0 0 1 1 0 0 1\n");
  program.require_failure("solver loose.usg", 4, "not positive definite");
  program.require_failure("covariance loose.usg", 4, "hold one node");
}
