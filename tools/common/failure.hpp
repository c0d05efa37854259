// SPDX-License-Identifier: MIT
// Exit codes of the programs and the exception that carries one with its line.
#pragma once

#include <stdexcept>
#include <string>

namespace unisim::tools {

inline constexpr int kExitDone = 0;
inline constexpr int kExitOther = 1;  ///< interrupted, or an error of the program
inline constexpr int kExitUsage = 2;
inline constexpr int kExitInput = 3;
inline constexpr int kExitLimit = 4;  ///< a limit or a device

/// Ends a program with one line on stderr: what, where, what to do.
class Failure : public std::runtime_error {
 public:
  Failure(int code, const std::string& line) : std::runtime_error(line), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

}  // namespace unisim::tools
