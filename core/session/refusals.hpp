// SPDX-License-Identifier: MIT
// Which predictions were refused and why: counted, remembered, logged.
#pragma once

#include <cstdint>

#include "core/base/counter.hpp"
#include "core/base/event_log.hpp"
#include "core/snapshot/archive.hpp"

namespace unisim {

enum class PredictionKind : int32_t { kPair, kWindow, kLoop };

/// Numbers of UNISIM_REFUSED_*.
enum class RefusalReason : int32_t {
  kNone = 0,
  kSigma = 1,    ///< center_sigma beyond its gate
  kScatter = 2,  ///< depth ratios scatter beyond their gate
  kViews = 3,    ///< fewer than two views take part
  kRange = 4,    ///< its unit is out of the range of numbers
  kHost = 5,     ///< the host rejected the request
  kRoom = 6,     ///< no room for one more open window
  kLate = 7      ///< its keyframes have left before it came
};

/// A prediction that was refused.
struct Refusal {
  RefusalReason reason = RefusalReason::kNone;
  int32_t first_keyframe = -1;
  int32_t last_keyframe = -1;
  double value = 0.0;  ///< what was beyond `limit`, for the reasons that have a gate
  double limit = 0.0;
};

/// Keeps the newest refusal of each kind and how many there were.
class Refusals {
 public:
  /// @param log outlives it
  explicit Refusals(const LogSink& log) : log_(log) {}

  /// Count it, remember it, and tell the log unless the host itself refused it.
  void add(PredictionKind kind, const Refusal& refusal);

  const Refusal& newest(PredictionKind kind) const { return newest_[index(kind)]; }
  int32_t count(PredictionKind kind) const { return counts_[index(kind)]; }

  /// Save or load.
  void visit(Archive* archive);

 private:
  static int index(PredictionKind kind) { return static_cast<int>(kind); }

  const LogSink& log_;
  Refusal newest_[3];
  Counter counts_[3];
};

}  // namespace unisim
