// SPDX-License-Identifier: MIT
// The cameras of the machine as a table for people.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/v4l2/io_table.hpp"

namespace unisim::v4l2 {

/// @param[out] cameras their number
std::string camera_table(Io& io, int32_t* cameras);

}  // namespace unisim::v4l2
