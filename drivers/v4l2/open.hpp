// SPDX-License-Identifier: MIT
// Opening with a table of system calls that the caller gives.
#pragma once

#include "drivers/v4l2/io_table.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {

/// As unisim_v4l2_open(). @param io outlives the source
unisim_source* open_camera(Io& io, const unisim_v4l2_config* config, int32_t* problem,
                           char* message, size_t message_size);

}  // namespace unisim::v4l2
