// SPDX-License-Identifier: MIT
// Finds landmarks again that went out of sight: projected into the image, then followed from a
// stored patch. They hold the scale over time better than anything else.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/patch_atlas.hpp"
#include "drivers/geometric/image/patch_store.hpp"
#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

class Revive {
 public:
  /// @param atlas to draw patches in; nothing of it is kept from one call to the next
  explicit Revive(PatchAtlas* atlas) : atlas_(*atlas) {}
  void reserve(size_t landmarks);

  /// Adds tracks for landmarks found in `current`, the image of a frame with this pose.
  /// @param mask set where none may be; changed  @param flow start velocity of the new tracks
  /// @return number of tracks added at the end of the list
  int run(const PatchStore& patches, const PreparedImage& current, const CameraPose& pose,
          int32_t keyframe, const cv::Point2f& flow, cv::Mat* mask, State* state);

  /// Keeps patches of the tracked landmarks whose view is unlike those kept so far.
  void store_patches(const State& state, const PreparedImage& current, int32_t keyframe,
                     PatchStore* patches) const;

  int64_t bytes() const;

 private:
  struct Candidate {
    int32_t landmark;
    int patch;
    double cost;  // of the difference in view, 0: same
    cv::Point2f expected;
  };
  void collect(const PatchStore& patches, const CameraPose& pose, int32_t keyframe,
               const cv::Mat& occupied, const State& state);
  void draw(const PatchStore& patches, size_t i, size_t j);

  std::vector<Candidate> candidates_;
  PatchAtlas& atlas_;
};

}  // namespace unisim::geometric
