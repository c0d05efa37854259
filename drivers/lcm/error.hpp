// SPDX-License-Identifier: MIT
// The one exception of this driver, and the edge between it and the C API where something is made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "drivers/lcm/problem.h"

namespace unisim::lcm {

/// A line for the user, and what kind of problem it is.
class LcmError : public std::runtime_error {
 public:
  /// @param problem UNISIM_LCM_*
  LcmError(int32_t problem, const std::string& line)
      : std::runtime_error("lcm: " + line), problem_(problem) {}
  int32_t problem() const { return problem_; }

 private:
  int32_t problem_;
};

/// What `make` returns, a pointer; nullptr when it throws, and why.
/// @param[out] problem UNISIM_LCM_*; may be nullptr, as `message` may
/// @param[out] message one line, cut to `capacity` bytes
template <class Make>
auto create(int32_t* problem, char* message, size_t capacity, Make make) -> decltype(make()) {
  int32_t kind = UNISIM_LCM_OK;
  std::string line;
  decltype(make()) made = nullptr;
  try {
    made = make();
  } catch (const LcmError& error) {
    kind = error.problem();
    line = error.what();
  } catch (const std::exception& error) {
    kind = UNISIM_LCM_NO_MEMORY;
    line = std::string("lcm: ") + error.what();
  }
  if (problem != nullptr) *problem = kind;
  if (made == nullptr && message != nullptr && capacity > 0) {
    std::snprintf(message, capacity, "%s", line.c_str());
  }
  return made;
}

}  // namespace unisim::lcm
