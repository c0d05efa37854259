// SPDX-License-Identifier: MIT
// What one inference costs, and what it may.
#include "drivers/onnx/runtime/cost.hpp"

#include <chrono>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/memory_use.hpp"

namespace unisim::onnx {

Cost first_run(const std::string& path, int32_t views, const std::vector<PeakMemory>& stated,
               const std::function<std::string()>& run) {
  Cost cost;
  cost.views = views;
  std::string problem;
  const auto timed_run = [&] {
    const auto start = std::chrono::steady_clock::now();
    problem = run();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    cost.seconds = spent.count();
  };
  if (stated.empty()) {
    cost.bytes = peak_growth_bytes(timed_run);
  } else {
    timed_run();
    cost.bytes = peak_bytes(stated, views);
  }
  if (!problem.empty()) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path + ": cannot run " + std::to_string(views) + " view(s): " + problem);
  }
  return cost;
}

void require_fit(const std::string& path, const Cost& cost, const MemoryBudget& budget) {
  const int64_t needed = budget.needed(cost);
  if (needed <= budget.bytes) return;
  throw OnnxError(UNISIM_ONNX_NO_MEMORY,
                  path + ": " + std::to_string(cost.views) + " view(s) take " +
                      std::to_string((needed >> 20) + 1) + " MB, more than the " +
                      std::to_string(budget.bytes >> 20) +
                      " MB allowed; raise the memory option or export a smaller input size");
}

}  // namespace unisim::onnx
