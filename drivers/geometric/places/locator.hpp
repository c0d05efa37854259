// SPDX-License-Identifier: MIT
// Where in the map single frames were taken; the map stays as it is.
#pragma once

#include <opencv2/core.hpp>

#include "drivers/geometric/image/prepared_image.hpp"
#include "drivers/geometric/places/places.hpp"

namespace unisim::geometric {

/// Follows a camera through the map from frame to frame, and looks for it anew in the whole map
/// where it is not where it should be. Both are judged alike, by patches: an error does not grow.
class Locator {
 public:
  /// @param[out] followed the frame was found where the one before let expect it
  /// @return false: not found
  bool run(const State& state, const PatchStore& patches, const unisim_image& image, Places* places,
           PlaceFound* out, bool* followed);

 private:
  int32_t nearest_keyframe(const State& state) const;
  void note(const State& state, const PlaceFound& found);

  ImagePreparation preparation_;
  PreparedImage current_;
  int32_t segment_ = -1;  // of the last frame; -1: it was not found
  CameraPose last_;
  CameraPose expected_;  // of the next one, as the camera moved last
  bool moving_ = false;  // the frame before was found too
};

}  // namespace unisim::geometric
