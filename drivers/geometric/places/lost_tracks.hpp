// SPDX-License-Identifier: MIT
// Tracks that Lucas-Kanade lost between two keyframes are looked for by what the images look like:
// large steps (photos, few frames a second, fast motion) leave it too few.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/geometric/image/patch_atlas.hpp"
#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/image/tracks.hpp"
#include "drivers/geometric/map/state.hpp"
#include "drivers/geometric/places/nearest_descriptors.hpp"
#include "drivers/geometric/places/orb.hpp"

namespace unisim::geometric {

class LostTracks {
 public:
  /// @param orb, atlas scratch that others use between calls
  LostTracks(Orb* orb, PatchAtlas* atlas) : orb_(orb), atlas_(atlas) {}
  /// @param most tracks that are wanted  @param tracks there may be
  void reserve(int most, size_t tracks);

  /// Remembers the tracks of the newest keyframe, which are looked for at the next one.
  void note_keyframe(const State& state);

  /// Have so many been lost since that keyframe that it is worth a look?
  bool many(const Tracks& tracks) const;

  /// Looks for the lost ones in the present image and adds those that are found; surviving tracks
  /// that contradict them go. Features that match tell where each patch went and how it was turned
  /// and scaled, the patch itself decides, and one motion of the camera has to explain all.
  /// @param keyframe, current images of the last keyframe and of this one
  /// @param flow that new tracks begin with  @return how many were added
  int run(const PreparedImage& keyframe, const PreparedImage& current, const cv::Point2f& flow,
          State* state);

  int64_t bytes() const;

 private:
  /// A point of the last keyframe and where it is now.
  struct Pair {
    size_t track;  // of those remembered; of a feature nothing
    cv::Point2f from;
    cv::Point2f to;
  };
  void find_seeds(const PreparedImage& keyframe, const PreparedImage& current);
  bool explain(const State& state, std::vector<Pair>* pairs);
  bool motion_near(const cv::Point2f& from, cv::Matx23d* motion) const;
  void expect_lost(const State& state);
  void find_patches(const PreparedImage& keyframe, const PreparedImage& current,
                    const State& state);

  Orb* orb_;
  PatchAtlas* atlas_;
  int most_ = 0;
  std::vector<cv::Point2f> points_;  // of the tracks of the last keyframe
  std::vector<int32_t> landmarks_;
  std::vector<uint32_t> generations_;
  OrbFeatureSet before_;  // of the last keyframe
  OrbFeatureSet now_;
  bool before_known_ = false;  // from the look before this one
  bool now_known_ = false;
  std::vector<OrbDescriptor> descriptors_;
  std::vector<int32_t> corners_;
  std::vector<FeaturePair> matches_;
  std::vector<Pair> seeds_;  // features
  std::vector<Pair> expected_;
  std::vector<cv::Matx23d> motions_;  // of each expected one
  std::vector<Pair> found_;
  std::vector<cv::Point2f> from_;
  std::vector<cv::Point2f> to_;
  std::vector<uint8_t> alive_;  // by landmark
  std::vector<uint8_t> bad_;    // surviving tracks
};

}  // namespace unisim::geometric
