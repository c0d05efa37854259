// SPDX-License-Identifier: MIT
// Where in the map an image was taken: candidates by their looks, each verified.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drivers/common/place_reports.hpp"
#include "drivers/geometric/places/nearest_descriptors.hpp"
#include "drivers/geometric/places/patch_check.hpp"
#include "drivers/geometric/places/place_list.hpp"
#include "drivers/geometric/places/place_view.hpp"
#include "drivers/predictor.h"

namespace unisim::geometric {

/// A pose in the map and the landmarks that say so.
struct PlaceFound {
  int32_t keyframe = -1;  ///< the candidate
  CameraPose pose;
  int32_t in_view = 0;  ///< landmarks that were looked for
  std::vector<PatchMatch> matches;
};

class PlaceFinder {
 public:
  PlaceFinder(const unisim_geometric_config& config, PatchAtlas* atlas);
  void open(const cv::Size& size);

  /// Describes the image of keyframe `id`, which may be asked for and added then.
  void see(const cv::Mat& gray, int32_t id);
  bool seen(int32_t id) const { return seen_ == id; }
  /// The keyframe seen last has a pose now.
  void add(const State& state);

  /// Where to look: for a loop, for a segment to join, or anywhere while the track is lost.
  enum class Scope { kSegment, kOtherSegments, kAll };
  struct Question {
    Scope scope;
    int32_t gap;    ///< keyframes between the image and a candidate, at least
    int32_t tries;  ///< candidates
  };
  /// Looks for the keyframe seen last in the map.
  /// @param log gets what was tried
  bool find(const State& state, const DescriptorStore& store, const PatchStore& patches,
            const PreparedImage& current, const Question& question, PlaceFound* out,
            drivers::PlaceReports* log);
  /// The same anywhere in the map in bounded time, for a frame of which nothing is known: of
  /// question.tries candidates those few are verified that most of the strongest features match.
  /// @param skip candidates that are left out, the most alike first
  /// @param[out] end there are no more after these
  bool find_quickly(const State& state, const DescriptorStore& store, const PatchStore& patches,
                    const PreparedImage& current, const Question& question, int32_t skip,
                    PlaceFound* out, bool* end);
  /// Whether an image shows what keyframe `keyframe` saw, from `expected`.
  bool look_near(const State& state, const DescriptorStore& store, const PatchStore& patches,
                 const PreparedImage& current, int32_t keyframe, const CameraPose& expected,
                 PlaceFound* out);

  /// See PlaceList::archive().
  void archive(drivers::Archive* io, const std::vector<int32_t>& held) { list_.archive(io, held); }

  Orb& orb() { return orb_; }
  int64_t bytes() const;

 private:
  bool verify(const State& state, const PatchStore& patches, const PreparedImage& current,
              PlaceFound* out, unisim_place_report* report);
  bool check(const State& state, const PatchStore& patches, const PreparedImage& current,
             const CameraPose& pose, PlaceFound* out, unisim_place_report* report);
  bool pose_from_features(const State& state, CameraPose* pose, unisim_place_report* report);
  bool linked(const State& state) const;

  const unisim_geometric_config& config_;
  Orb orb_;
  PlaceList list_;
  PlaceViewer viewer_;
  PatchCheck check_;
  OrbFeatureSet features_;
  std::array<int8_t, kVladSize> descriptor_{};
  bool describable_ = false;
  int32_t seen_ = -1;
  PlaceView view_;
  /// Of find_quickly().
  struct Candidate {
    int32_t keyframe;
    size_t matches;
  };
  std::vector<Candidate> candidates_;
  std::vector<FeaturePair> pairs_;
  std::vector<PoseObservation> observations_;
  std::vector<uint8_t> inlier_;
  PatchCheckResult checked_;
};

}  // namespace unisim::geometric
