// SPDX-License-Identifier: MIT
// Whether landmarks look as their patches say at a supposed pose: the judge of all candidates.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/bundle/pose_solver.hpp"
#include "drivers/geometric/image/patch_atlas.hpp"
#include "drivers/geometric/image/patch_store.hpp"
#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// A landmark found in an image.
struct PatchMatch {
  int32_t landmark = -1;
  uint32_t generation = 0;
  cv::Point2f point;
};

struct PatchCheckResult {
  int in_view = 0;  ///< landmarks looked for
  CameraPose pose;  ///< refined
  std::vector<PatchMatch> inliers;
};

class PatchCheck {
 public:
  /// @param atlas to draw patches in; nothing of it is kept from one call to the next
  explicit PatchCheck(PatchAtlas* atlas) : atlas_(*atlas) {}
  /// @param landmarks slots to look for  @param start supposed pose of the image
  void run(const State& state, const PatchStore& patches, const PreparedImage& current,
           const int32_t* landmarks, size_t count, const CameraPose& start, PatchCheckResult* out);

 private:
  struct Target {
    int32_t landmark;
    int patch;
    cv::Point2f expected;
    cv::Matx23d patch_of_tile;  // where in the patch a pixel of the tile is
  };
  bool aim(const State& state, const PatchStore& patches, int32_t landmark, const CameraPose& pose,
           Target* out) const;
  void draw(const PatchStore& patches, size_t i, size_t j);
  void match_contrast(const cv::Mat& image);
  void follow(const State& state, const PatchStore& patches, const PreparedImage& current,
              double reach, std::vector<PatchMatch>* found);

  std::vector<Target> targets_;
  PatchAtlas& atlas_;
  std::vector<double> ratios_;
  std::vector<PoseObservation> observations_;
  std::vector<uint8_t> inlier_;
};

}  // namespace unisim::geometric
