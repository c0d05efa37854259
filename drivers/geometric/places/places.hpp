// SPDX-License-Identifier: MIT
// What the mapper has to do with places: keep them, find a lost camera, close loops, join segments.
#pragma once

#include <vector>

#include "drivers/geometric/places/bridge_book.hpp"
#include "drivers/geometric/places/loop_book.hpp"
#include "drivers/geometric/places/place_finder.hpp"

namespace unisim::geometric {

class Places {
 public:
  /// @param atlas see PatchCheck
  Places(const unisim_geometric_config& config, size_t tracks, PatchAtlas* atlas);
  void open(const cv::Size& size) { finder_.open(size); }

  /// A keyframe as all steps see it.
  struct Look {
    const State& state;
    const cv::Mat& gray;  ///< as it came
    const PreparedImage& current;
    const PatchStore& patches;
    int32_t keyframe;
  };

  /// While the track is lost: where in the map is the keyframe?
  bool relocalise(const Look& look, PlaceFound* out);
  /// Where in the map is an image that is no keyframe? Nothing is kept of it.
  bool locate(const Look& look, PlaceFound* out);
  /// Is it at `expected`, by what keyframe `keyframe` saw?
  bool look_near(const Look& look, int32_t keyframe, const CameraPose& expected, PlaceFound* out);
  /// A keyframe has its pose: keeps the place, and looks for older views of it, in its segment and
  /// in others.
  void keep(const Look& look);

  Orb& orb() { return finder_.orb(); }
  LoopBook& loops() { return loops_; }
  /// Is another segment known to lie so and so to the present one? See BridgeBook::take().
  bool take_join(const State& state, SegmentJoin* out, std::vector<LoopObservation>* observations);
  /// No more keyframes come: loops that wait for a second to agree are given up.
  void finish(const State& state);
  /// Fills the fields on places.
  void info(unisim_predictor_info* out) const;
  int64_t bytes() const;

  /// Saves or loads what one landmark looks like.
  void archive_landmark(drivers::Archive* io, int32_t landmark, uint32_t generation) {
    store_.archive(io, landmark, generation);
  }
  /// Saves or loads what the keyframes look like. @param held keyframes that the state holds
  void archive_keyframes(drivers::Archive* io, const std::vector<int32_t>& held) {
    finder_.archive(io, held);
  }

 private:
  void try_loop(const Look& look);
  void try_bridge(const Look& look);
  void drop_unconfirmed(const State& state, int32_t newest);
  void withdraw(int32_t keyframe, int32_t asked);

  const unisim_geometric_config& config_;
  PlaceFinder finder_;
  DescriptorStore store_;
  LoopBook loops_;
  BridgeBook bridges_;
  PlaceFound found_;
  drivers::PlaceReports reports_;
  int32_t relocalised_ = 0;
  int32_t skip_ = 0;  // candidates that frames before this one have tried, see locate()
  int32_t joined_ = 0;
};

}  // namespace unisim::geometric
