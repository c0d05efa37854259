// SPDX-License-Identifier: MIT
// Recognises frames that hold the images of two eyes side by side.
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "drivers/geometric/start/start_statistics.hpp"

namespace unisim::geometric {

namespace {

constexpr int kHeight = 120;        // pixels at which the halves are compared
constexpr int kBlock = 16;          // side of a compared block
constexpr double kMaxShift = 0.25;  // of a half: what disparity may move a block
constexpr double kMinContrast = 4;  // grey levels: a flat block fits anywhere
constexpr double kAlike = 0.8;      // correlation that other places of one image seldom reach
constexpr double kMinShare = 0.6;   // of the blocks with contrast
constexpr size_t kMinBlocks = 8;    // with contrast, to say anything

}  // namespace

bool halves_alike(const cv::Mat& prepared) {
  const double scale = static_cast<double>(kHeight) / prepared.rows;
  const cv::Size size(static_cast<int>(scale * prepared.cols) / 2 * 2, kHeight);
  if (size.width < 4 * kBlock) return false;
  cv::Mat small;
  cv::resize(prepared, small, size, 0, 0, cv::INTER_AREA);
  const int half = size.width / 2;
  const int reach = static_cast<int>(kMaxShift * half);
  size_t blocks = 0;
  size_t found = 0;
  for (int y = 0; y + kBlock <= kHeight; y += kBlock) {
    for (int x = 0; x + kBlock <= half; x += kBlock) {
      const cv::Mat block = small(cv::Rect(x, y, kBlock, kBlock));
      cv::Scalar mean;
      cv::Scalar contrast;
      cv::meanStdDev(block, mean, contrast);
      if (contrast[0] < kMinContrast) continue;
      const int first = half + std::max(0, x - reach);
      const int last = half + std::min(half, x + kBlock + reach);
      cv::Mat score;
      cv::matchTemplate(small(cv::Rect(first, y, last - first, kBlock)), block, score,
                        cv::TM_CCOEFF_NORMED);
      double best = 0;
      cv::minMaxLoc(score, nullptr, &best);
      ++blocks;
      found += best > kAlike ? 1 : 0;
    }
  }
  return blocks >= kMinBlocks &&
         static_cast<double>(found) >= kMinShare * static_cast<double>(blocks);
}

}  // namespace unisim::geometric
