// SPDX-License-Identifier: MIT
// unisim-bench window: a long walk through a session.
#pragma once

#include "tools/bench/walk/walk_run.hpp"

namespace unisim::bench {

/// Print what the walk cost and how right it is. @return exit code
/// @throws replay::Failure
int walk_command(const WalkSettings& settings, bool json);

}  // namespace unisim::bench
