// SPDX-License-Identifier: MIT
// Patches side by side in one image, and where they are found in another: as many as there is room
// for at a time.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/patch_store.hpp"
#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/image/two_way_flow.hpp"

namespace unisim::geometric {

class PatchAtlas {
 public:
  /// @param size of the images that patches are looked for in
  void open(const cv::Size& size);
  size_t capacity() const;  ///< patches at a time

  void clear();
  /// Where patch j goes, kPatchSide x kPatchSide.
  cv::Mat tile(size_t j);
  cv::Point corner(size_t j) const;  ///< of that tile, in the atlas
  /// The next patch has been put into its tile.
  /// @param from the point in the atlas  @param expected where it should be in the image
  void add(const cv::Point2f& from, const cv::Point2f& expected);
  size_t size() const { return flow_.size(); }
  const cv::Point2f& expected(size_t j) const { return expected_[j]; }
  cv::Mat& gray() { return atlas_.gray; }

  /// Looks for the patches in an image. @param least_texture see TwoWayFlow
  void find(const PreparedImage& image, double least_texture);
  const cv::Point2f& found_at(size_t j) const { return flow_.to(j); }
  /// Patch j was found: it came back, lies within `reach` pixels of where it was expected and
  /// `margin` from the border, and looks there as it does here.
  bool found(size_t j, const PreparedImage& image, double reach, float margin) const;

  int64_t bytes() const;

 private:
  PreparedImage atlas_;
  TwoWayFlow flow_;
  std::vector<cv::Point2f> expected_;
};

}  // namespace unisim::geometric
