// SPDX-License-Identifier: MIT
// The one exception of this driver, and the edge between it and the C API where something is made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "drivers/common/creation.hpp"
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

/// drivers::create() with the problems of this driver.
template <class Make>
auto create(int32_t* problem, char* message, size_t capacity, Make make) -> decltype(make()) {
  return drivers::create<LcmError>("lcm: ", UNISIM_LCM_NO_MEMORY, problem, message, capacity, make);
}

}  // namespace unisim::lcm
