// SPDX-License-Identifier: MIT
// Gives out each pose as soon as it is known, once, to those who act by it.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/map_builder.hpp"
#include "drivers/pipeline/session_client.hpp"
#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::pipeline {

class LivePoses {
 public:
  struct Parts {
    SessionClient* session;
    unisim_predictor* predictor;
    MapBuilder* map;
    const std::vector<Listener*>* listeners;
    Progress* progress;  ///< `metre` is set here, `newest_ns` is read
    bool at_clock;       ///< live or realtime: a pose can be late
  };

  explicit LivePoses(const Parts& parts) : parts_(parts) {}

  /// Keyframes before this one are of a map that was loaded: their poses are not live ones.
  void begin_at(int32_t keyframe) { next_ = keyframe; }

  /// The pose of a frame that has become keyframe `id`, where the predictor knows it by now: what
  /// a keyframe takes comes after the pose that is waited for.
  void give_early(const unisim_frame& frame, int32_t id);

  /// Keyframes that have their pose in the map by now.
  /// @param ending no frame comes any more: all of them are late
  void give_keyframes(bool ending);

  /// A frame between keyframes.
  void give_between(const unisim_frame& frame);

  /// A frame found in a map that stays as it is.
  void give_located(const LocatedFrame& frame, int32_t segment);

  /// Whether a pose has been given out.
  bool any() const { return any_; }

 private:
  bool pose_of_frame(const unisim_frame& frame, int32_t id, unisim_frame_pose* place,
                     LivePose* pose);
  Metre metre(int32_t segment) { return parts_.map->metres().of(segment); }
  void give(const LivePose& pose);

  Parts parts_;
  int32_t next_ = 0;    // first keyframe whose pose is not told yet
  int32_t early_ = -1;  // keyframe whose frame's pose was given out before
  bool any_ = false;
};

}  // namespace unisim::pipeline
