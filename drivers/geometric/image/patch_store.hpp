// SPDX-License-Identifier: MIT
// Small image patches of landmarks, from which landmarks that went out of sight are found again.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/common/archive.hpp"

namespace unisim::geometric {

inline constexpr int kPatchSide = 32;  ///< pixels, even
inline constexpr int kPatchesPerLandmark = 2;

/// What a patch shows: landmark `generation` as seen in a keyframe.
struct PatchView {
  uint32_t generation = 0;  ///< 0: empty
  int32_t keyframe = -1;
  cv::Point2f offset;  ///< of the landmark from the patch's pixel (kPatchSide/2, kPatchSide/2)
};

/// kPatchesPerLandmark patches for each landmark slot.
class PatchStore {
 public:
  explicit PatchStore(int32_t landmarks);

  const PatchView& view(int32_t landmark, int index) const { return views_[at(landmark, index)]; }
  /// The pixels of a patch, kPatchSide x kPatchSide.
  cv::Mat pixels(int32_t landmark, int index) const;
  /// Cuts a patch around `point`; beyond the border the image's edge is repeated.
  void store(int32_t landmark, int index, uint32_t generation, int32_t keyframe,
             const cv::Mat& gray, const cv::Point2f& point);
  /// Saves or loads the patches of one landmark; those of older generations are left out.
  void archive(drivers::Archive* io, int32_t landmark, uint32_t generation);
  int64_t bytes() const;

 private:
  static size_t at(int32_t landmark, int index) {
    return static_cast<size_t>(landmark) * kPatchesPerLandmark + static_cast<size_t>(index);
  }
  std::vector<PatchView> views_;
  std::vector<uint8_t> pixels_;
};

}  // namespace unisim::geometric
