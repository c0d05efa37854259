// SPDX-License-Identifier: MIT
// How many keyframes the windows of a run have and share, where the user leaves it open.
#pragma once

#include <string_view>

#include "drivers/predictor.h"
#include "tools/replay/settings.hpp"

namespace unisim::replay {

/// The overlap that suits a predictor, unless one is given.
void set_default_overlap(std::string_view predictor, Settings* settings);

/// Fits the session's windows to the predictor: a recording is asked for the windows it holds, a
/// network for no more views than it and the memory can take.
/// @param predictor of --predictor `name`, not inside a recorder
void fit_windows(std::string_view name, const unisim_predictor* predictor, Settings* settings);

}  // namespace unisim::replay
