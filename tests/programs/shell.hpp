// SPDX-License-Identifier: MIT
// Runs the programs through a shell, in a folder of their own.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/support/temp_folder.hpp"

namespace unisim::testing {

class Shell {
 public:
  /// Runs in the folder; "replay", "eval", ... stand for the programs where they come first.
  /// @return exit code
  int run(const std::string& program, const std::string& rest) {
    const std::string command =
        "cd '" + folder_.path() + "' && exec 2> err.txt && '" + path_of(program) + "' " + rest;
    const int status = std::system(command.c_str());
    err = content("err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  static std::string path_of(const std::string& program) {
    if (program == "replay") return UNISIM_REPLAY_PROGRAM;
    if (program == "eval") return UNISIM_EVAL_PROGRAM;
    if (program == "synth") return UNISIM_SYNTH_PROGRAM;
    if (program == "bench") return UNISIM_BENCH_PROGRAM;
    return UNISIM_ARENA_PROGRAM;
  }

  std::string content(const std::string& name) const { return read_file(folder_ / name); }

  const TempFolder& folder() const { return folder_; }

  std::string err;  ///< stderr of the last run

 private:
  TempFolder folder_;
};

}  // namespace unisim::testing
