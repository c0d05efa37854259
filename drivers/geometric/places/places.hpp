// SPDX-License-Identifier: MIT
// What the mapper has to do with places: keep them, find a lost camera, close loops.
#pragma once

#include <vector>

#include "drivers/geometric/places/loop_book.hpp"
#include "drivers/geometric/places/place_finder.hpp"

namespace unisim::geometric {

class Places {
 public:
  Places(const unisim_geometric_config& config, size_t tracks);
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
  /// A keyframe has its pose: keeps the place, and looks for older views of it.
  void keep(const Look& look);

  LoopBook& loops() { return loops_; }
  /// No more keyframes come: loops that wait for a second to agree are given up.
  void finish();
  /// Fills the fields on places.
  void info(unisim_predictor_info* out) const;
  int64_t bytes() const;

 private:
  void try_loop(const Look& look);
  void drop_unconfirmed(int32_t newest);
  void note_tried();

  const unisim_geometric_config& config_;
  PlaceFinder finder_;
  DescriptorStore store_;
  LoopBook loops_;
  PlaceFound found_;
  std::vector<unisim_place_report> tried_;    // in the last search
  std::vector<unisim_place_report> reports_;  // the newest of the run
  int32_t loops_tried_ = 0;
  int32_t loops_accepted_ = 0;
  int32_t relocalised_ = 0;
};

}  // namespace unisim::geometric
