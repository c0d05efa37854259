// SPDX-License-Identifier: MIT
// Binary descriptors (ORB) of an image and of given points.
#include "drivers/geometric/places/orb.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "drivers/common/image_mat.hpp"

namespace unisim::geometric {

namespace {

constexpr int kAsked = 2500;   // so many that each cell of the grid has its own
constexpr float kStep = 1.2F;  // from one level of the pyramid to the next
constexpr int kLevels = 8;
constexpr int kPatch = 31;
constexpr int kRadius = kPatch / 2;
constexpr int kFast = 10;
constexpr int kDetectBorder = 19;
constexpr int kDescribeBorder = 8;  // of given points: as near the border as they are followed
constexpr int kColumns = 20;
constexpr int kRows = 15;
constexpr std::array<int, kOrbScales> kOctaves = {0, 3, 6};

/// Direction from a pixel to the centroid of the gray values around it, degrees.
float direction(const cv::Mat& level, const cv::Point2f& at) {
  const int x = cvRound(at.x);
  const int y = cvRound(at.y);
  int64_t sum_x = 0;
  int64_t sum_y = 0;
  for (int v = -kRadius; v <= kRadius; ++v) {
    const auto* row = level.ptr<uint8_t>(std::clamp(y + v, 0, level.rows - 1));
    const int reach = static_cast<int>(std::sqrt(kRadius * kRadius + 1 - v * v));
    for (int u = -reach; u <= reach; ++u) {
      const int gray = row[std::clamp(x + u, 0, level.cols - 1)];
      sum_x += u * gray;
      sum_y += v * gray;
    }
  }
  return cv::fastAtan2(static_cast<float>(sum_y), static_cast<float>(sum_x));
}

}  // namespace

Orb::Orb()
    : detector_(cv::ORB::create(kAsked, kStep, kLevels, kDetectBorder, 0, 2, cv::ORB::HARRIS_SCORE,
                                kPatch, kFast)),
      describer_(cv::ORB::create(kAsked, kStep, kLevels, kDescribeBorder, 0, 2,
                                 cv::ORB::HARRIS_SCORE, kPatch, kFast)) {}

void Orb::open(const cv::Size& size, const unisim_image& look) {
  if (look.data != nullptr) look_ = drivers::image_mat(look) != 0;
  for (size_t s = 0; s < kOrbScales; ++s) {
    const double scale = std::pow(kStep, kOctaves[s]);
    levels_[s].create(cvRound(size.height / scale), cvRound(size.width / scale), CV_8UC1);
  }
}

void Orb::describe(const cv::Mat& gray, OrbFeatureSet* out) {
  detector_->detectAndCompute(gray, look_.empty() ? cv::noArray() : cv::InputArray(look_), found_,
                              descriptors_);
  order_.resize(found_.size());
  std::iota(order_.begin(), order_.end(), size_t{0});
  std::stable_sort(order_.begin(), order_.end(),
                   [this](size_t a, size_t b) { return found_[a].response > found_[b].response; });
  std::array<int, static_cast<size_t>(kColumns) * kRows> taken{};
  rank_.assign(found_.size(), 0);
  for (const size_t k : order_) {
    const int column = static_cast<int>(found_[k].pt.x) * kColumns / gray.cols;
    const int row = static_cast<int>(found_[k].pt.y) * kRows / gray.rows;
    rank_[k] = taken[static_cast<size_t>(row * kColumns + column)]++;
  }
  std::stable_sort(order_.begin(), order_.end(),
                   [this](size_t a, size_t b) { return rank_[a] < rank_[b]; });
  if (order_.size() > kOrbFeatures) order_.resize(kOrbFeatures);
  out->point.clear();
  out->descriptor.create(static_cast<int>(order_.size()), kOrbBytes, CV_8UC1);
  for (size_t i = 0; i < order_.size(); ++i) {
    out->point.push_back(found_[order_[i]].pt);
    descriptors_.row(static_cast<int>(order_[i])).copyTo(out->descriptor.row(static_cast<int>(i)));
  }
}

void Orb::describe_points(const cv::Mat& gray, const std::vector<cv::Point2f>& points,
                          std::vector<OrbDescriptor>* out, std::vector<uint8_t>* valid) {
  out->assign(points.size() * kOrbScales, OrbDescriptor{});
  valid->assign(points.size(), 0);
  found_.clear();
  for (size_t s = 0; s < kOrbScales; ++s) {
    const auto scale = static_cast<float>(std::pow(kStep, kOctaves[s]));
    cv::resize(gray, levels_[s], levels_[s].size(), 0, 0, cv::INTER_LINEAR);
    for (size_t i = 0; i < points.size(); ++i) {
      const float angle = direction(levels_[s], points[i] / scale);
      found_.emplace_back(points[i], kPatch * scale, angle, 1.0F, kOctaves[s],
                          static_cast<int>(i * kOrbScales + s));
    }
  }
  if (found_.empty()) return;
  describer_->compute(gray, found_, descriptors_);
  for (size_t k = 0; k < found_.size(); ++k) {
    const auto at = static_cast<size_t>(found_[k].class_id);
    const auto* row = descriptors_.ptr<uint8_t>(static_cast<int>(k));
    std::copy(row, row + kOrbBytes, (*out)[at].begin());
    (*valid)[at / kOrbScales] =
        static_cast<uint8_t>((*valid)[at / kOrbScales] | (1U << (at % kOrbScales)));
  }
}

int64_t Orb::bytes() const {
  size_t images = look_.total();
  for (const cv::Mat& level : levels_) images += level.total();
  const size_t feature = sizeof(cv::KeyPoint) + kOrbBytes + sizeof(int) + sizeof(size_t);
  return static_cast<int64_t>(images + kAsked * feature);
}

}  // namespace unisim::geometric
