// SPDX-License-Identifier: MIT
// The features followed at present, as parallel arrays.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace unisim::geometric {

/// One entry per live track; every track belongs to a landmark slot of the map.
struct Tracks {
  std::vector<cv::Point2f> point;           ///< in the frame seen last
  std::vector<cv::Point2f> velocity;        ///< last displacement between frames
  std::vector<cv::Point2f> keyframe_point;  ///< in the last keyframe, where `sealed`
  std::vector<int32_t> landmark;
  std::vector<uint8_t> sealed;  ///< was seen in the last keyframe

  void reserve(size_t count) {
    point.reserve(count);
    velocity.reserve(count);
    keyframe_point.reserve(count);
    landmark.reserve(count);
    sealed.reserve(count);
  }
  size_t size() const { return point.size(); }
  void add(const cv::Point2f& at, const cv::Point2f& flow, int32_t landmark_slot) {
    point.push_back(at);
    velocity.push_back(flow);
    keyframe_point.push_back(at);
    landmark.push_back(landmark_slot);
    sealed.push_back(0);
  }
  /// Removes the tracks whose flag is set, order kept.
  void remove(const std::vector<uint8_t>& bad) {
    size_t kept = 0;
    for (size_t i = 0; i < size(); ++i) {
      if (bad[i]) continue;
      point[kept] = point[i];
      velocity[kept] = velocity[i];
      keyframe_point[kept] = keyframe_point[i];
      landmark[kept] = landmark[i];
      sealed[kept] = sealed[i];
      ++kept;
    }
    resize(kept);
  }
  void clear() { resize(0); }
  /// The present points become those of the last keyframe.
  void seal() {
    keyframe_point = point;
    std::fill(sealed.begin(), sealed.end(), uint8_t{1});
  }

 private:
  void resize(size_t count) {
    point.resize(count);
    velocity.resize(count);
    keyframe_point.resize(count);
    landmark.resize(count);
    sealed.resize(count);
  }
};

}  // namespace unisim::geometric
