// SPDX-License-Identifier: MIT
// Durations of one stage in constant memory: percentiles to 2.5 %, the maximum exactly.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace unisim::pipeline {

class LatencyHistogram {
 public:
  void add_ms(double ms);

  int64_t count() const { return count_; }
  double max_ms() const { return max_ms_; }

  /// Duration that `share` (0..1) of all durations do not exceed; 0 when there is none.
  double percentile_ms(double share) const;

 private:
  // Buckets grow by 5 % from 1 microsecond; the last one holds everything above 100 s.
  static constexpr int kBuckets = 380;
  std::array<int64_t, kBuckets> buckets_{};
  int64_t count_ = 0;
  double max_ms_ = 0.0;
};

/// Adds the time between construction and destruction to a histogram.
class ScopedLatency {
 public:
  explicit ScopedLatency(LatencyHistogram& histogram)
      : histogram_(histogram), start_(std::chrono::steady_clock::now()) {}
  ~ScopedLatency() {
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start_;
    histogram_.add_ms(spent.count());
  }
  ScopedLatency(const ScopedLatency&) = delete;
  ScopedLatency& operator=(const ScopedLatency&) = delete;

 private:
  LatencyHistogram& histogram_;
  std::chrono::steady_clock::time_point start_;
};

/// Where the time of a run goes.
struct StageTimes {
  LatencyHistogram decode;       ///< one frame from the source
  LatencyHistogram observe;      ///< predictor sees one frame
  LatencyHistogram keyframe;     ///< predictor takes one keyframe
  LatencyHistogram two_view;     ///< predictor answers one pair
  LatencyHistogram multi_view;   ///< predictor answers one window
  LatencyHistogram revision;     ///< predictor says what it has measured anew, once a keyframe
  LatencyHistogram depth_ratio;  ///< session takes a pair or a window: mostly its depth ratios
  LatencyHistogram descriptor;   ///< predictor describes one keyframe; none where it closes loops
  LatencyHistogram loop;         ///< one search for loops: predictions of old keyframes
  LatencyHistogram graph;        ///< session takes a keyframe, a revision or a refusal
  LatencyHistogram read;         ///< session says what it wants, where it stands, a pose
  LatencyHistogram optimize;     ///< one unisim_optimize()
  LatencyHistogram track_total;  ///< keyframe: image at hand to its pose in the map
};

}  // namespace unisim::pipeline
