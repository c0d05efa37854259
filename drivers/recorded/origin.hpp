// SPDX-License-Identifier: MIT
// Which predictor a recording is of.
#pragma once

#include "drivers/predictor.h"

namespace unisim::recorded {

/// The name in the file of a predictor of unisim_recorded_open(); NULL for any other predictor.
const char* recorded_origin(const unisim_predictor* predictor);

}  // namespace unisim::recorded
