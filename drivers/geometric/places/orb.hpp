// SPDX-License-Identifier: MIT
// Binary descriptors (ORB): of the strongest features of an image, and of given points.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "drivers/geometric/places/vlad.hpp"
#include "drivers/image.h"

namespace unisim::geometric {

inline constexpr int kOrbScales = 3;       ///< at which given points are described: 1, 1.7, 3
inline constexpr int kOrbFeatures = 1000;  ///< of an image

using OrbDescriptor = std::array<uint8_t, kOrbBytes>;

/// Features of an image, spread over a grid.
struct OrbFeatureSet {
  std::vector<cv::Point2f> point;  ///< pixels
  cv::Mat descriptor;              ///< a row of kOrbBytes for each
};

class Orb {
 public:
  Orb();
  /// @param look as unisim_geometric_config.mask
  void open(const cv::Size& size, const unisim_image& look);

  /// The kOrbFeatures strongest features: of each cell of a grid the strongest first.
  void describe(const cv::Mat& gray, OrbFeatureSet* out);

  /// Descriptors of given points at each of kOrbScales, in their order.
  /// @param[out] out   points.size() * kOrbScales
  /// @param[out] valid bit s of each point: the descriptor at scale s is there (the point lies far
  ///                   enough from the border)
  void describe_points(const cv::Mat& gray, const std::vector<cv::Point2f>& points,
                       std::vector<OrbDescriptor>* out, std::vector<uint8_t>* valid);

  /// Between calls; OpenCV takes a pyramid of the image during one.
  int64_t bytes() const;

 private:
  cv::Ptr<cv::ORB> detector_;
  cv::Ptr<cv::ORB> describer_;
  cv::Mat look_;  // 0: nowhere; empty: everywhere
  std::vector<cv::KeyPoint> found_;
  cv::Mat descriptors_;
  std::vector<int> rank_;
  std::vector<size_t> order_;
  std::array<cv::Mat, kOrbScales> levels_;
};

}  // namespace unisim::geometric
