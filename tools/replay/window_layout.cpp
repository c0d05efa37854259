// SPDX-License-Identifier: MIT
// How many keyframes the windows of a run have and share.
#include "tools/replay/window_layout.hpp"

#include <algorithm>

#include "drivers/onnx/onnx.h"
#include "drivers/pipeline/session_defaults.hpp"
#include "drivers/recorded/recorded.h"

namespace unisim::replay {
void set_default_overlap(std::string_view predictor, Settings* settings) {
  if (settings->window_overlap_given) return;
  settings->session.window_overlap =
      pipeline::usual_overlap(predictor, settings->session.window_size);
}

void fit_windows(std::string_view name, const unisim_predictor* predictor, Settings* settings) {
  unisim_config& session = settings->session;
  int32_t size = 0;
  int32_t overlap = 0;
  if (name == "recorded" && unisim_recorded_windows(predictor, &size, &overlap) != 0) {
    if (!settings->window_size_given) session.window_size = size;
    if (!settings->window_overlap_given) session.window_overlap = overlap;
  }
  if (name == "onnx" && unisim_onnx_window_size(predictor) < session.window_size) {
    session.window_size = unisim_onnx_window_size(predictor);
    session.window_overlap = std::min(session.window_overlap, session.window_size / 2);
  }
}

}  // namespace unisim::replay
