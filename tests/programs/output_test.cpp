// SPDX-License-Identifier: MIT
// Output that is lost is said, by every program and in every mode.
#include <algorithm>
#include <utility>
#include <vector>

#include "tests/programs/shell.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using unisim::testing::Shell;

namespace {

constexpr const char* kTruth = "0 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 2 2 0 0 0 0 1\n";
constexpr const char* kGraph =
    "node 0 T 1 0 0 0 1 0 0 0 1\nnode 1 T 0 0 0 0 1 1 0.5 0 1\nnode 2 T 0 0 0 0 1 2 0.5 0 1\n"
    "edge v2v 0 1 1 0 0 0 0 1 1 0 0 1\nedge v2v 1 2 1 0 0 0 0 1 1 0 0 1\n";
constexpr const char* kCloud =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
    "z\nend_header\n0 0 0\n1 0 0\n";

/// A folder with small inputs, and each program with something to say.
class Talkative : public Shell {
 public:
  Talkative() {
    folder().write("gt.txt", kTruth);
    folder().write("graph.usg", kGraph);
    folder().write("gt.ply", kCloud);
  }

  const std::vector<std::pair<std::string, std::string>> modes = {
      {"replay", "--help"},
      {"replay", "--version"},
      {"replay", "--print-config"},
      {"eval", "--help"},
      {"eval", "--version"},
      {"eval", "ate --help"},
      {"eval", "ate gt.txt gt.txt"},
      {"eval", "ate gt.txt gt.txt --json"},
      {"eval", "rpe gt.txt gt.txt"},
      {"eval", "cloud gt.ply gt.ply"},
      {"synth", "--help"},
      {"synth", "--version"},
      {"synth", "out --scene lowtexture --size 64x48 --frames 1 --force"},
      {"bench", "--help"},
      {"bench", "--version"},
      {"bench", "solver --help"},
      {"bench", "solver graph.usg"},
      {"bench", "solver graph.usg --json"},
      {"bench", "covariance graph.usg"},
      {"bench", "depth --repeat 1"},
      {"bench", "depth --repeat 1 --json"},
      {"bench", "window --keyframes 32 --batch off"},
      {"arena", "--help"},
      {"arena", "--version"},
      {"arena", ""}};
};

}  // namespace

TEST_CASE("output on a full device is exit code 4 and one line") {
  Talkative shell;
  for (const auto& [program, arguments] : shell.modes) {
    INFO(program << " " << arguments);
    CHECK(shell.run(program, arguments + " > /dev/full") == 4);
    INFO(shell.err);
    CHECK(has(shell.err, "unisim-" + program + ": output lost: No space left on device"));
    CHECK(std::count(shell.err.begin(), shell.err.end(), '\n') == 1);
  }
}

TEST_CASE("output to nowhere is lost too and goes into no file of the program") {
  Talkative shell;
  for (const auto& [program, arguments] : shell.modes) {
    INFO(program << " " << arguments);
    CHECK(shell.run(program, arguments + " >&-") == 4);
    INFO(shell.err);
    CHECK(has(shell.err, "output lost"));
  }
}

TEST_CASE("a reader that has seen enough is no error") {
  Talkative shell;
  for (const auto& [program, arguments] : shell.modes) {
    INFO(program << " " << arguments);
    // The reader is gone before the program has started.
    shell.run("eval", "--help > /dev/null; { sleep 0.1; '" + Shell::path_of(program) + "' " +
                          arguments + "; echo $? > code.txt; } | true");
    INFO(shell.err);
    CHECK(shell.content("code.txt") == "0\n");
    CHECK(!has(shell.err, "output lost"));
  }
}
