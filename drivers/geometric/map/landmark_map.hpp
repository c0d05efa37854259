// SPDX-License-Identifier: MIT
// Keyframes, landmarks and the observations between them, in memory fixed at creation.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "drivers/common/archive.hpp"
#include "drivers/geometric/bundle/camera_model.hpp"
#include "drivers/geometric/map/keyframe_slots.hpp"

namespace unisim::geometric {

struct MapCapacity {
  int32_t keyframes;
  int32_t landmarks;
  int32_t observations_per_keyframe;
};

/// Names one observation: a keyframe id and the place in it.
struct ObservationRef {
  int32_t keyframe = -1;
  int32_t index = -1;
  bool valid() const { return keyframe >= 0; }
};

/// Where a pixel would have been seen, were all rows read at the time of the middle one.
/// @param sway see map/rolling_shutter.hpp
inline Eigen::Vector2d still_pixel(const cv::Point2f& at, const cv::Point2f& sway,
                                   double readout_s) {
  return {at.x - readout_s * sway.x, at.y - readout_s * sway.y};
}

/// Where a landmark was seen in a keyframe. Observations of a landmark form a list in time order.
struct Observation {
  int32_t landmark = -1;  ///< -1: the landmark is no longer in the map
  float x = 0;
  float y = 0;
  bool outlier = false;
  cv::Point2f sway;  ///< see map/rolling_shutter.hpp
  ObservationRef next;
  Eigen::Vector2d pixel() const { return {x, y}; }
  Eigen::Vector2d still(double readout_s) const { return still_pixel({x, y}, sway, readout_s); }
};

struct Keyframe {
  int32_t id = -1;
  int32_t segment = 0;
  bool posed = false;
  CameraPose pose;          ///< world to camera
  double center_sigma = 0;  ///< of the centre over median depth, landmarks known; 0: not known
  int32_t observations = 0;
};

enum class LandmarkState : uint8_t {
  kFree,       ///< slot not in use
  kCandidate,  ///< followed, no position yet
  kPlaced,     ///< has a position
  kRefused     ///< failed too often; kept only while it is followed
};

struct Landmark {
  LandmarkState state = LandmarkState::kFree;
  bool soft = false;      ///< depth guessed from neighbours, parallax still missing
  bool followed = false;  ///< a live track belongs to it
  int32_t failures = 0;
  int32_t segment = 0;
  uint32_t generation = 0;  ///< counts the uses of the slot
  int32_t observations = 0;
  int32_t measured_at = 0;  ///< keyframe with which its depth became a measurement
  ObservationRef first;
  ObservationRef last;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world
};

class LandmarkMap {
 public:
  explicit LandmarkMap(const MapCapacity& capacity);

  /// Appends keyframe `id` (above all before it); when all places are taken the one that the others
  /// can best do without goes (least_needed.hpp).
  Keyframe& push_keyframe(int32_t id, int32_t segment);
  bool holds(int32_t id) const { return slots_.find(id) >= 0; }
  const std::vector<int32_t>& ids() const { return slots_.ids(); }  ///< held, ascending
  int32_t end_id() const { return end_id_; }                        ///< one past the newest
  /// Number below the capacity that no other held keyframe has.
  size_t slot_of(int32_t id) const { return static_cast<size_t>(slots_.find(id)); }
  Keyframe& keyframe(int32_t id) { return keyframes_[slot_of(id)]; }
  const Keyframe& keyframe(int32_t id) const { return keyframes_[slot_of(id)]; }

  /// A new landmark in a free slot; the landmark out of sight for longest goes when none is free.
  int32_t add_landmark(int32_t segment);
  void free_landmark(int32_t slot);
  int32_t landmark_capacity() const { return static_cast<int32_t>(landmarks_.size()); }
  Landmark& landmark(int32_t slot) { return landmarks_[static_cast<size_t>(slot)]; }
  const Landmark& landmark(int32_t slot) const { return landmarks_[static_cast<size_t>(slot)]; }

  /// Adds an observation in the newest keyframe. @return false when the keyframe is full
  bool observe(int32_t slot, const cv::Point2f& at, const cv::Point2f& sway = {});
  /// Adds an observation in an older keyframe. @return false when it is full or has the landmark
  bool observe_in(int32_t keyframe, int32_t slot, const cv::Point2f& at);
  Observation& observation(const ObservationRef& ref) {
    return observations_[slot_of(ref.keyframe) * per_keyframe_ + static_cast<size_t>(ref.index)];
  }
  const Observation& observation(const ObservationRef& ref) const {
    return observations_[slot_of(ref.keyframe) * per_keyframe_ + static_cast<size_t>(ref.index)];
  }
  const Observation& observation(int32_t keyframe, int32_t index) const {
    return observation(ObservationRef{keyframe, index});
  }

  /// Frees every landmark without a position that is no longer followed.
  void free_abandoned();

  /// Calls f(ObservationRef, Observation&) for each observation of a landmark, oldest first.
  template <typename F>
  void for_each_observation(int32_t slot, F&& f) {
    for (ObservationRef ref = landmark(slot).first; ref.valid();) {
      Observation& seen = observation(ref);
      const ObservationRef next = seen.next;
      f(ref, seen);
      ref = next;
    }
  }
  template <typename F>
  void for_each_observation(int32_t slot, F&& f) const {
    for (ObservationRef ref = landmark(slot).first; ref.valid();) {
      const Observation& seen = observation(ref);
      f(ref, seen);
      ref = seen.next;
    }
  }

  /// An observation that counts: in a posed keyframe and not an outlier.
  bool counts(const ObservationRef& ref) const {
    return keyframe(ref.keyframe).posed && !observation(ref).outlier;
  }
  /// First observation that counts; invalid if there is none.
  ObservationRef anchor(int32_t slot) const;
  /// Number of observations that count.
  int32_t support(int32_t slot) const;

  int64_t bytes() const;

  /// Will the landmark be there when a saved map is loaded?
  bool lasts(int32_t slot) const;
  /// Saves the map, or loads one into a map that is as it was made. Landmarks keep their slots.
  /// @param segments numbers of segments that are taken
  /// @param readout_s observations are saved as if all rows were read at once
  void archive(drivers::Archive* io, int32_t segments, double readout_s);

 private:
  void archive_landmark(drivers::Archive* io, int32_t slot, int32_t segments);
  void archive_keyframe(drivers::Archive* io, int32_t id, int32_t segments, double readout_s);
  void archive_observation(drivers::Archive* io, Observation& seen) const;
  void load_observation(drivers::Archive* io);
  bool full(int32_t id) const {
    return static_cast<size_t>(keyframe(id).observations) == per_keyframe_;
  }
  /// Puts an observation into keyframe `id`; it is not in the landmark's list yet.
  ObservationRef write(int32_t id, int32_t slot, const cv::Point2f& at);
  void drop_keyframe(int32_t id);
  /// Takes one observation out of its landmark's list.
  void unlink(const ObservationRef& ref);
  void free_oldest_landmarks();

  size_t per_keyframe_;
  KeyframeSlots slots_;
  int32_t end_id_ = 0;
  std::vector<Keyframe> keyframes_;
  std::vector<Observation> observations_;
  std::vector<Landmark> landmarks_;
  std::vector<int32_t> free_;
  std::vector<int32_t> scratch_;
};

}  // namespace unisim::geometric
