// SPDX-License-Identifier: MIT
// Exit codes of the program and the exception that carries one with its line.
#pragma once

#include <stdexcept>
#include <string>

namespace unisim::replay {

inline constexpr int kExitDone = 0;
inline constexpr int kExitOther = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitInput = 3;
inline constexpr int kExitLimit = 4;

/// Ends the program with one line on stderr: what, where, what to do.
class Failure : public std::runtime_error {
 public:
  Failure(int code, const std::string& line) : std::runtime_error(line), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

}  // namespace unisim::replay
