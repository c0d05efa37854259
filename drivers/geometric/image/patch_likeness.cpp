// SPDX-License-Identifier: MIT
// How alike the surroundings of two points are.
#include "drivers/geometric/image/patch_likeness.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace unisim::geometric {

namespace {
constexpr int kSide = 13;  // pixels
}  // namespace

double correlation(const cv::Mat& a, const cv::Point2f& at_a, const cv::Mat& b,
                   const cv::Point2f& at_b) {
  const cv::Size side(kSide, kSide);
  cv::Mat p;
  cv::Mat q;
  cv::getRectSubPix(a, side, at_a, p, CV_32F);
  cv::getRectSubPix(b, side, at_b, q, CV_32F);
  cv::Scalar mean_p, mean_q, sigma_p, sigma_q;
  cv::meanStdDev(p, mean_p, sigma_p);
  cv::meanStdDev(q, mean_q, sigma_q);
  const double covariance = p.dot(q) / side.area() - mean_p[0] * mean_q[0];
  return covariance / std::max(1e-6, sigma_p[0] * sigma_q[0]);
}

}  // namespace unisim::geometric
