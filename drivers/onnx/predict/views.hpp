// SPDX-License-Identifier: MIT
// The newest keyframes as one model wants them; shared by the roles of that model.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "drivers/image.h"
#include "drivers/onnx/image/preprocessor.hpp"
#include "drivers/onnx/model/encoder.hpp"
#include "drivers/onnx/predict/place_images.hpp"
#include "drivers/onnx/predict/view_store.hpp"

namespace unisim::onnx {

/// A ring of inputs: images brought to the model's size, or what its encoder makes of these, once.
/// One thread adds while others copy.
class Views {
 public:
  /// @param contract    of the model or of its encoder
  /// @param encoder     NULL for a model that takes images
  /// @param view_floats of the model's input
  Views(const Contract& contract, std::shared_ptr<Encoder> encoder, int64_t view_floats,
        int32_t capacity);

  /// Keyframes that have left the ring are looked for there.
  void set_places(const PlaceImages* places) { places_ = places; }

  /// All images have this size; takes the memory that follows from it. Before the first add().
  void set_image_size(int32_t width, int32_t height);

  /// A new keyframe; the oldest one's place is used again.
  Answer add(int32_t id, const unisim_image& image);

  /// @param[out] view the model's input
  /// @return "" or why there is none
  std::string copy(int32_t id, float* view);

  const Framing& framing() const { return preprocessor_->framing(); }
  const Encoder* encoder() const { return encoder_.get(); }
  int32_t capacity() const { return capacity_; }
  int64_t ring_bytes() const { return store_.bytes(); }
  int64_t bytes() const;

 private:
  Answer make(const unisim_image& image, float* view);
  std::string restore(int32_t id, float* view);
  size_t place(int32_t id) const { return static_cast<size_t>(id % capacity_); }

  Contract contract_;
  std::shared_ptr<Encoder> encoder_;
  int32_t capacity_;
  mutable std::mutex mutex_;
  ViewStore store_;
  std::vector<std::string> problems_;  // by place in the ring, "" where there is a view
  std::optional<Preprocessor> preprocessor_;
  const PlaceImages* places_ = nullptr;
  std::vector<uint8_t> pixels_;  // of an image that was kept
};

}  // namespace unisim::onnx
