// SPDX-License-Identifier: MIT
// How a session is laid out where nobody says otherwise.
#include "drivers/pipeline/session_defaults.hpp"

#include <algorithm>
#include <limits>

namespace unisim::pipeline {

int32_t keyframe_capacity(const unisim_config& session, int64_t frames,
                          const KeyframeConfig& keyframes, int32_t when_unknown, int32_t places) {
  if (session.window_submaps > 0) {
    // As unisim.h asks for. Wide windows and revisions reach back as far as a predictor remembers.
    const int32_t least = (session.window_submaps + 9) * session.window_size;
    constexpr int32_t kRemembered = 320;
    return std::max({least, kRemembered, places});
  }
  if (frames < 0) return when_unknown;
  const int64_t gap = std::max(keyframes.stride > 0 ? keyframes.stride : keyframes.min_gap, 1);
  const int64_t needed = frames / gap + 2;
  constexpr int64_t kLargest = std::numeric_limits<int32_t>::max();
  return static_cast<int32_t>(std::min(needed, kLargest));
}

}  // namespace unisim::pipeline
