// SPDX-License-Identifier: MIT
// What a host says of lengths while a run goes, on its way to the pipeline's thread.
#include "drivers/pipeline/distance_inbox.hpp"

#include <algorithm>

namespace unisim::pipeline {

bool DistanceInbox::add(const OdometryStep& step, double common_sigma) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (step.from_ns < end_ns_ || steps_.size() >= kMost) return false;
  steps_.push_back(step);
  end_ns_ = step.to_ns;
  common_sigma_ = std::max(common_sigma_, common_sigma);
  return true;
}

bool DistanceInbox::add(const unisim_distance& distance) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (distances_.size() >= kMost) return false;
  distances_.push_back(distance);
  return true;
}

void DistanceInbox::take(std::vector<OdometryStep>* steps, std::vector<unisim_distance>* distances,
                         double* common_sigma) {
  steps->clear();
  distances->clear();
  const std::lock_guard<std::mutex> lock(mutex_);
  steps->swap(steps_);
  distances->swap(distances_);
  *common_sigma = common_sigma_;
}

}  // namespace unisim::pipeline
