// SPDX-License-Identifier: MIT
// What an optimisation tells a listener that measures it. The core itself has no clock.
#pragma once

#include <cstdint>

namespace unisim {

/// What an optimisation is about to do; a phase lasts until the next call of the listener.
enum class LmPhase : int32_t {
  kOrder,      ///< read the structure, order the columns
  kAnalyze,    ///< elimination tree and structure of the factor
  kLinearize,  ///< residuals, Jacobian products, their sums in H and g; gives the cost too
  kFactorize,  ///< numeric factorisation, with the forward solve
  kSolve,      ///< backward solve
  kStep,       ///< judge the step, move the poses
  kAccept,     ///< a state has been taken: the first one, then each lower cost
  kEnd         ///< back to the caller; not called when no iteration was tried
};

/// Optional listener; without a function it costs nothing.
struct LmObserver {
  /// @param iteration accepted and rejected steps before the present one
  /// @param cost      of the last state taken; 0 before the first
  void (*enter)(LmPhase phase, int32_t iteration, double cost, void* user) = nullptr;
  void* user = nullptr;
};

}  // namespace unisim
