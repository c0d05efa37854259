// SPDX-License-Identifier: MIT
// Runs the programs under test and keeps their files in a folder of its own.
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace unisim::testing {

struct ProgramResult {
  int code = -1;    ///< exit code, 128 + n when signal n ended it
  std::string out;  ///< stdout
  std::string err;  ///< stderr
};

/// Where the output of a run goes.
enum class Reader {
  kReads,       ///< kept for ProgramResult
  kGone,        ///< pipes that nobody reads any more
  kFullDevice,  ///< stdout only
};

/// Limits and disturbances of a run.
struct Disturbance {
  std::string interrupt_on;  ///< `signal` is sent once this stands in the output
  int signal = SIGINT;
  bool hangup_ignored = false;  ///< as by nohup
  Reader reader = Reader::kReads;
  long max_file_bytes = -1;  ///< as on a full disk: larger files cannot be written
};

/// A program with these arguments.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          const Disturbance& disturbance = {});

/// unisim-replay with these arguments.
ProgramResult run_replay(const std::vector<std::string>& arguments,
                         const Disturbance& disturbance = {});

/// A rendered sequence of 80 frames, 320x240, with ground truth; made by the build, read only.
std::string rendered_sequence();
/// Rows read one after the other, 25 ms from the first to the last.
std::string rolling_sequence();

/// The same in 160x120.
std::string small_sequence();

/// 110 frames of 160x120 of a camera at rest, no two with the same pixels.
std::string still_sequence();

void write_file(const std::string& path, const std::string& text);

}  // namespace unisim::testing
