// SPDX-License-Identifier: MIT
// What the landmarks look like: binary descriptors at three scales, of the first view and the
// newest.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/geometric/map/state.hpp"
#include "drivers/geometric/places/orb.hpp"

namespace unisim::geometric {

inline constexpr int kDescribedViews = 2;

/// kDescribedViews x kOrbScales descriptors for each landmark slot: 192 bytes.
class DescriptorStore {
 public:
  explicit DescriptorStore(int32_t landmarks, size_t tracks);

  /// Describes the tracked landmarks of the newest keyframe that have no view yet, or whose newest
  /// view is some keyframes old.
  void see(const State& state, const cv::Mat& gray, int32_t keyframe, Orb* orb);

  /// Appends the descriptors of a landmark as rows.
  void append(int32_t landmark, uint32_t generation, std::vector<OrbDescriptor>* out) const;

  /// Saves or loads the descriptors of one landmark; those of older generations are left out.
  void archive(drivers::Archive* io, int32_t landmark, uint32_t generation);

  int64_t bytes() const;

 private:
  struct View {
    uint8_t valid = 0;  // bit s: scale s
    int32_t keyframe = -1;
  };
  struct Entry {
    uint32_t generation = 0;  // 0: empty
    View view[kDescribedViews];
  };
  bool wanted(const Entry& entry, uint32_t generation, int32_t keyframe) const;
  void store(int32_t landmark, uint32_t generation, int32_t keyframe, size_t point);

  std::vector<Entry> entries_;
  std::vector<OrbDescriptor> descriptors_;
  std::vector<cv::Point2f> points_;
  std::vector<int32_t> slots_;
  std::vector<OrbDescriptor> fresh_;
  std::vector<uint8_t> valid_;
};

}  // namespace unisim::geometric
