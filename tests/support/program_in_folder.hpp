// SPDX-License-Identifier: MIT
// A program that runs in a folder of its own, and what it said.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

class ProgramInFolder {
 public:
  explicit ProgramInFolder(std::string path) : path_(std::move(path)) {}

  /// Runs in the folder. @return exit code, -1 for a signal
  int run(const std::string& arguments) {
    const std::string command =
        "cd '" + folder_.path() + "' && '" + path_ + "' " + arguments + " > out.txt 2> err.txt";
    const int status = std::system(command.c_str());
    out = read_file(folder_ / "out.txt");
    err = read_file(folder_ / "err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// Runs and expects one line on stderr that names `part`.
  void require_failure(const std::string& arguments, int code, const std::string& part) {
    INFO(arguments);
    REQUIRE(run(arguments) == code);
    INFO(err);
    REQUIRE(std::count(err.begin(), err.end(), '\n') == 1);
    REQUIRE(err.find(part) != std::string::npos);
  }

  const TempFolder& folder() const { return folder_; }
  std::string out, err;  ///< of the last run

 private:
  std::string path_;
  TempFolder folder_;
};
