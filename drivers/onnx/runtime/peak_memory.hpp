// SPDX-License-Identifier: MIT
// Peak memory of an inference as a model's file states it: unisim.peak_bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace unisim::onnx {

/// Of one inference with so many views, beyond the loaded model.
struct PeakMemory {
  int32_t views = 0;
  int64_t bytes = 0;
};

/// "2:123456 16:654321", views rising; nothing when the text is something else.
std::optional<std::vector<PeakMemory>> read_peaks(const std::string& text);

/// Linear between the numbers of views given. Below the first its bytes; above the last they grow
/// with the square of the views, the most that attention over all of them can take.
/// @param stated one or more
int64_t peak_bytes(const std::vector<PeakMemory>& stated, int32_t views);

}  // namespace unisim::onnx
