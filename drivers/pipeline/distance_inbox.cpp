// SPDX-License-Identifier: MIT
// What a host says of lengths while a run goes, on its way to the pipeline's thread.
#include "drivers/pipeline/distance_inbox.hpp"

#include <algorithm>
#include <utility>

namespace unisim::pipeline {

bool DistanceInbox::add(const OdometryStep& step, double common_sigma) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (step.from_ns < end_ns_ || content_.steps.size() >= kMost) return false;
  content_.steps.push_back(step);
  end_ns_ = step.to_ns;
  common_sigma_ = std::max(common_sigma_, common_sigma);
  return true;
}

bool DistanceInbox::add(const OdometryPosition& position, double common_sigma) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (position.time_ns <= end_ns_ || content_.positions.size() >= kMost) return false;
  content_.positions.push_back(position);
  end_ns_ = position.time_ns;
  common_sigma_ = std::max(common_sigma_, common_sigma);
  return true;
}

bool DistanceInbox::add(const unisim_distance& distance) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (content_.distances.size() >= kMost) return false;
  content_.distances.push_back(distance);
  return true;
}

void DistanceInbox::take(Content* content, double* common_sigma) {
  content->steps.clear();
  content->positions.clear();
  content->distances.clear();
  const std::lock_guard<std::mutex> lock(mutex_);
  std::swap(*content, content_);
  *common_sigma = common_sigma_;
}

}  // namespace unisim::pipeline
