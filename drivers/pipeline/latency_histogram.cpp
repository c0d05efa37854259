// SPDX-License-Identifier: MIT
// Durations of one stage in constant memory.
#include "drivers/pipeline/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::pipeline {
namespace {

constexpr double kFirstEdgeMs = 1e-3;
const double kLogGrowth = std::log(1.05);

}  // namespace

void LatencyHistogram::add_ms(double ms) {
  int bucket = 0;
  if (ms > kFirstEdgeMs) bucket = static_cast<int>(std::log(ms / kFirstEdgeMs) / kLogGrowth) + 1;
  ++buckets_[static_cast<size_t>(std::min(bucket, kBuckets - 1))];
  ++count_;
  max_ms_ = std::max(max_ms_, ms);
}

double LatencyHistogram::percentile_ms(double share) const {
  if (count_ == 0) return 0.0;
  const double wanted = share * static_cast<double>(count_);
  int64_t seen = 0;
  for (int bucket = 0; bucket < kBuckets; ++bucket) {
    seen += buckets_[static_cast<size_t>(bucket)];
    if (static_cast<double>(seen) < wanted) continue;
    const double middle = kFirstEdgeMs * std::exp((bucket - 0.5) * kLogGrowth);
    return std::min(middle, max_ms_);
  }
  return max_ms_;
}

}  // namespace unisim::pipeline
