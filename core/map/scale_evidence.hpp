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

/// A value among its like, by median and median absolute deviation.
struct Consensus {
  double median = 0.0;
  double spread = 0.0;  ///< standard deviation that the median absolute deviation stands for
  int32_t count = 0;

  /// Whether a measurement belongs to the others: within four standard deviations, its own and
  /// theirs together. Among fewer than five nobody can say.
  bool accepts(double value, double information) const;
};

/// Reorders `values`, of which there is at least one.
Consensus consensus_of(Span<double> values);

}  // namespace unisim
