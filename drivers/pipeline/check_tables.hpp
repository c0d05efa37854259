// SPDX-License-Identifier: MIT
// Are the tables of a source and a predictor ones that this library knows?
#pragma once

#include "drivers/pipeline/session_client.hpp"
#include "drivers/predictor.h"
#include "drivers/source.h"

namespace unisim::pipeline {

/// Tables of programs built against an older header than the first with places are refused.
Preparation check_tables(const unisim_source& source, const unisim_predictor& predictor);

}  // namespace unisim::pipeline
