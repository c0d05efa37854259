// SPDX-License-Identifier: MIT
// What is known of the length of a unit in metres: mean of the logarithm with its information.
#pragma once

#include <cstdint>

#include "core/base/span.hpp"

namespace unisim {

/// Normal distribution of log(metres per unit). information 0: nothing is known.
struct ScaleEvidence {
  double log_metres = 0.0;
  double information = 0.0;  ///< inverse variance

  bool known() const { return information > 0.0; }
  /// The same of a unit that is `factor` times as long.
  ScaleEvidence of_unit(double log_factor) const { return {log_metres + log_factor, information}; }
};

/// Both, as independent measurements.
ScaleEvidence fuse(const ScaleEvidence& one, const ScaleEvidence& other);

/// Independent measurements of one unit. Where they scatter more than they say, they are as unsure
/// as they scatter.
ScaleEvidence fuse(Span<const ScaleEvidence> all);

/// What most of a few measurements of one unit say. A third of them may be off, all to one side,
/// and by no more than they scatter anyway: a wheel that slips makes a way longer, never shorter.
struct Consensus {
  double center = 0.0;
  double spread = 0.0;  ///< standard deviation of the half of them that is nearest together
  int32_t count = 0;

  /// How much of a measurement belongs to them: 1 at their center, 0 from three standard deviations
  /// on (its own, or what they scatter by where that is more). Among fewer than five nobody can
  /// say.
  double weight(const ScaleEvidence& one) const;
};

/// From the middle of the shortest half, where most lie, some rounds of Tukey's biweight. Reorders
/// `all`, of which there is at least one.
Consensus consensus_of(Span<ScaleEvidence> all);

}  // namespace unisim
