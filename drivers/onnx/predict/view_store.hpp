// SPDX-License-Identifier: MIT
// Inputs of the newest keyframes, ready for a model.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::onnx {

/// A ring of equal blocks of floats, each under the id of its keyframe. Takes memory once.
class ViewStore {
 public:
  ViewStore(int32_t capacity, int64_t view_floats);

  /// Block of a new keyframe; the oldest one's is reused. Ids ascend by one.
  float* add(int32_t id);
  /// NULL when the keyframe is not held (any more).
  const float* find(int32_t id) const;
  int64_t view_floats() const { return view_floats_; }
  int64_t bytes() const { return static_cast<int64_t>(floats_.size() * sizeof(float)); }

 private:
  int32_t capacity_;
  int64_t view_floats_;
  int32_t end_ = 0;  // id after the newest
  std::vector<float> floats_;
};

}  // namespace unisim::onnx
