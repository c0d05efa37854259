// SPDX-License-Identifier: MIT
// What one inference costs, and what it may.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drivers/onnx/runtime/peak_memory.hpp"

namespace unisim::onnx {

struct Cost {
  int32_t views = 0;
  double seconds = 0;  ///< of the first run; 0: not run
  int64_t bytes = 0;   ///< peak memory beyond that of the loaded model
};

/// Runs once, which makes later runs warm. Memory is measured, or taken from `stated` if there is
/// any. @param run returns "" or why it failed
/// @throws OnnxError (UNISIM_ONNX_BAD_MODEL) when it did
Cost first_run(const std::string& path, int32_t views, const std::vector<PeakMemory>& stated,
               const std::function<std::string()>& run);

/// Memory that inferences and the keyframes kept for them may take.
struct MemoryBudget {
  int64_t bytes = 0;
  int64_t kept_bytes = 0;           ///< of these, for keyframes kept whatever is inferred
  int64_t kept_bytes_per_view = 0;  ///< the same, for each view that an inference may have

  int64_t needed(const Cost& cost) const {
    return cost.bytes + kept_bytes + kept_bytes_per_view * cost.views;
  }
};

/// @throws OnnxError (UNISIM_ONNX_NO_MEMORY) when this does not fit
void require_fit(const std::string& path, const Cost& cost, const MemoryBudget& budget);

}  // namespace unisim::onnx
