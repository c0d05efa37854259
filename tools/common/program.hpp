// SPDX-License-Identifier: MIT
// How every program begins and ends.
#pragma once

#include <functional>

namespace unisim::tools {

/// Runs `body` and turns what it throws into one line on stderr and an exit code. Output that was
/// lost is such a failure too (4). A reader that goes away and a file over a size limit are errors
/// of the write from here on, not signals.
/// @param name as it stands before the line
/// @return exit code of the process
int run_program(const char* name, const std::function<int()>& body);

}  // namespace unisim::tools
