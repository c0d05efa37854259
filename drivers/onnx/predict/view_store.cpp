// SPDX-License-Identifier: MIT
// Inputs of the newest keyframes, ready for a model.
#include "drivers/onnx/predict/view_store.hpp"

namespace unisim::onnx {

ViewStore::ViewStore(int32_t capacity, int64_t view_floats)
    : capacity_(capacity),
      view_floats_(view_floats),
      floats_(static_cast<size_t>(capacity) * static_cast<size_t>(view_floats)) {}

float* ViewStore::add(int32_t id) {
  end_ = id + 1;
  return floats_.data() + (id % capacity_) * view_floats_;
}

const float* ViewStore::find(int32_t id) const {
  if (id < 0 || id >= end_ || id < end_ - capacity_) return nullptr;
  return floats_.data() + (id % capacity_) * view_floats_;
}

}  // namespace unisim::onnx
