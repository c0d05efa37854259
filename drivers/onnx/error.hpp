// SPDX-License-Identifier: MIT
// The one exception of this driver: a line for the user and what kind of problem it is.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "drivers/onnx/onnx.h"

namespace unisim::onnx {

class OnnxError : public std::runtime_error {
 public:
  /// @param problem UNISIM_ONNX_*
  OnnxError(int32_t problem, const std::string& line)
      : std::runtime_error(line), problem_(problem) {}
  int32_t problem() const { return problem_; }

 private:
  int32_t problem_;
};

}  // namespace unisim::onnx
