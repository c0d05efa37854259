// SPDX-License-Identifier: MIT
// unisim-bench updates: live updates of a pose graph from a file.
#pragma once

#include "tools/bench/solver/update_run.hpp"

namespace unisim::bench {

/// Print the times. @return exit code
/// @throws sequence::InputError, replay::Failure
int update_command(const UpdateSettings& settings);

}  // namespace unisim::bench
