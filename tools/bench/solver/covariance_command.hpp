// SPDX-License-Identifier: MIT
// unisim-bench covariance: marginal covariances of a pose graph from a file.
#pragma once

#include "tools/bench/solver/covariance_run.hpp"

namespace unisim::bench {

/// Print the times. @return exit code
/// @throws sequence::InputError, replay::Failure
int covariance_command(const CovarianceSettings& settings);

}  // namespace unisim::bench
