// SPDX-License-Identifier: MIT
// What the file of a recording says of itself.
#pragma once

#include "drivers/predictor.h"
#include "drivers/recorded/record_writer.hpp"

namespace unisim::recorded {

/// The start of the file of a predictor of unisim_recorded_open(); NULL for any other predictor.
const FileInfo* recorded_file(const unisim_predictor* predictor);

}  // namespace unisim::recorded
