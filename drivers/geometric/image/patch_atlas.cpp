// SPDX-License-Identifier: MIT
// Patches side by side in one image, and where they are found in another.
#include "drivers/geometric/image/patch_atlas.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "drivers/geometric/image/frame_tracker.hpp"

namespace unisim::geometric {

namespace {

constexpr int kLevels = 1;
constexpr double kMaxBackwardError = 1.0;  // pixels
constexpr double kMinCorrelation = 0.7;
constexpr int kCompared = 13;  // pixels: the side of what is correlated

/// Normalised cross-correlation of the surroundings of two points, -1..1.
double correlation(const cv::Mat& a, const cv::Point2f& at_a, const cv::Mat& b,
                   const cv::Point2f& at_b) {
  const cv::Size side(kCompared, kCompared);
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

}  // namespace

void PatchAtlas::open(const cv::Size& size) {
  atlas_.gray.create(size, CV_8UC1);
  atlas_.gray.setTo(0);
  flow_.reserve(capacity());
  expected_.reserve(capacity());
}

size_t PatchAtlas::capacity() const {
  return static_cast<size_t>(atlas_.gray.cols / kPatchSide) *
         static_cast<size_t>(atlas_.gray.rows / kPatchSide);
}

/// What is looked for at a tile's edge reaches beyond it: nothing older may stand there.
void PatchAtlas::clear() {
  atlas_.gray.setTo(kMiddleGray);
  flow_.clear();
  expected_.clear();
}

cv::Point PatchAtlas::corner(size_t j) const {
  const int columns = atlas_.gray.cols / kPatchSide;
  const int at = static_cast<int>(j);
  return {at % columns * kPatchSide, at / columns * kPatchSide};
}

cv::Mat PatchAtlas::tile(size_t j) {
  return atlas_.gray(cv::Rect(corner(j), cv::Size(kPatchSide, kPatchSide)));
}

void PatchAtlas::add(const cv::Point2f& from, const cv::Point2f& expected) {
  flow_.add(from, expected);
  expected_.push_back(expected);
}

void PatchAtlas::find(const PreparedImage& image, double least_texture) {
  cv::buildOpticalFlowPyramid(atlas_.gray, atlas_.pyramid, cv::Size(kTrackWindow, kTrackWindow),
                              kLevels, true);
  flow_.run(atlas_.pyramid, image.pyramid, kLevels, least_texture);
}

bool PatchAtlas::found(size_t j, const PreparedImage& image, double reach, float margin) const {
  return flow_.came_back(j, kMaxBackwardError) && cv::norm(flow_.to(j) - expected_[j]) < reach &&
         inside_image(flow_.to(j), image.gray.size(), margin) &&
         correlation(atlas_.gray, flow_.from(j), image.gray, flow_.to(j)) > kMinCorrelation;
}

int64_t PatchAtlas::bytes() const {
  return prepared_image_bytes(atlas_.gray.cols, atlas_.gray.rows);
}

}  // namespace unisim::geometric
