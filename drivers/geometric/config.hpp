// SPDX-License-Identifier: MIT
// Reads and checks the configuration a caller hands in.
#pragma once

#include <string>

#include "drivers/geometric/geometric.h"

namespace unisim::geometric {

/// Copies `in` (NULL: defaults) into `out`. @return an empty string, or what is wrong with it
std::string read_config(const unisim_geometric_config* in, unisim_geometric_config* out);

}  // namespace unisim::geometric
