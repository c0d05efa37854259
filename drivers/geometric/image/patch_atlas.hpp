// SPDX-License-Identifier: MIT
// Patches side by side in one image, and where they are found in another: as many as there is room
// for at a time.
#pragma once

#include <algorithm>
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
  /// Looks for `count` patches in an image, as many at a time as there is room for.
  /// @param draw (i, j) puts patch i into tile j and adds it  @param drawn () ends a round of them
  /// @param take (i, j) sees what was found of it
  template <class Draw, class Drawn, class Take>
  void look_for(size_t count, const PreparedImage& image, double least_texture, Draw draw,
                Drawn drawn, Take take) {
    const size_t tiles = capacity();
    for (size_t first = 0; tiles > 0 && first < count; first += tiles) {
      const size_t round = std::min(tiles, count - first);
      clear();
      for (size_t j = 0; j < round; ++j) draw(first + j, j);
      drawn();
      find(image, least_texture);
      for (size_t j = 0; j < round; ++j) take(first + j, j);
    }
  }
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
