// SPDX-License-Identifier: MIT
// What a keyframe looks like as a whole: by a model of kind descriptor, or without one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/image.h"
#include "drivers/onnx/onnx.h"

namespace unisim::onnx {

class PlaceDescriber {
 public:
  /// @param model NULL: VLAD of binary features, as in the geometric predictor
  explicit PlaceDescriber(unisim_onnx_descriptor* model);
  ~PlaceDescriber();
  PlaceDescriber(const PlaceDescriber&) = delete;
  PlaceDescriber& operator=(const PlaceDescriber&) = delete;

  /// @return UNISIM_PREDICTION_*; message() says why unless _OK
  int describe(const unisim_image& image);

  /// Of the last description.
  const std::vector<int8_t>& values() const { return values_; }
  const std::string& message() const { return message_; }

 private:
  struct Features;  // of images without a model
  int by_model(const unisim_image& image);
  int by_features(const unisim_image& image);

  unisim_onnx_descriptor* model_;
  std::unique_ptr<Features> features_;
  std::vector<int8_t> values_;
  std::string message_;
};

}  // namespace unisim::onnx
