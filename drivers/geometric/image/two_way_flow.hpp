// SPDX-License-Identifier: MIT
// Follows points from one image to another and back: what does not come back was not followed.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace unisim::geometric {

/// Least texture that OpenCV's Lucas-Kanade asks of a patch; see kMinTexture for less.
inline constexpr double kUsualTexture = 1e-4;

class TwoWayFlow {
 public:
  void reserve(size_t count);
  void clear();
  /// @param start where to begin in the other image
  void add(const cv::Point2f& from, const cv::Point2f& start);

  /// There from the starts, back from where the points are by then to where they came from.
  /// @param there, other pyramids of PreparedImage  @param levels above full resolution
  /// @param least_texture of a patch that is followed
  void run(const std::vector<cv::Mat>& there, const std::vector<cv::Mat>& other, int levels,
           double least_texture);

  size_t size() const { return from_.size(); }
  const cv::Point2f& from(size_t j) const { return from_[j]; }
  const cv::Point2f& to(size_t j) const { return to_[j]; }  ///< the start, until run()
  /// Followed both ways, to less than `error` pixels from where it began.
  bool came_back(size_t j, double error) const {
    return found_[j] && found_back_[j] && cv::norm(back_[j] - from_[j]) < error;
  }

 private:
  std::vector<cv::Point2f> from_;
  std::vector<cv::Point2f> to_;
  std::vector<cv::Point2f> back_;
  std::vector<uint8_t> found_;
  std::vector<uint8_t> found_back_;
  std::vector<float> error_;
};

}  // namespace unisim::geometric
