// SPDX-License-Identifier: MIT
// Builds without OpenCV keep no places: runs have no loops, all else is as usual.
#include "drivers/onnx/error.hpp"
#include "drivers/onnx/predict/place_describer.hpp"
#include "drivers/onnx/predict/place_images.hpp"
#include "drivers/predictor.h"

namespace unisim::onnx {

struct PlaceDescriber::Features {};

PlaceDescriber::PlaceDescriber(unisim_onnx_descriptor* model) : model_(model) {
  if (model_ == nullptr) return;
  unisim_onnx_descriptor_close(model_);
  throw OnnxError(
      UNISIM_ONNX_NOT_BUILT,
      "onnx.model_descriptor: loops are not in this build, which was made without OpenCV");
}

PlaceDescriber::~PlaceDescriber() = default;

int PlaceDescriber::describe(const unisim_image&) {
  message_ = "loops are not in this build, which was made without OpenCV";
  return UNISIM_PREDICTION_REJECTED;
}

void PlaceImages::add(int32_t, const unisim_image&) {}

void PlaceImages::release(int32_t) {}

unisim_image PlaceImages::find(int32_t, std::vector<uint8_t>*) const { return {}; }

int64_t PlaceImages::bytes() const { return bytes_; }

}  // namespace unisim::onnx
