// SPDX-License-Identifier: MIT
// What a model file says of itself: the metadata of the model contract, version 1.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drivers/onnx/runtime/peak_memory.hpp"

namespace unisim::onnx {

enum class Kind { kMultiview, kPair, kDescriptor, kEncoder };

/// How an image of another shape is brought to the model's; see framing.hpp.
enum class Resize { kFit, kCrop, kPad, kStretch };

struct Contract {
  Kind kind = Kind::kMultiview;
  std::string model;
  std::string license;
  int32_t height = 0;  ///< pixels of the model's input
  int32_t width = 0;
  int32_t min_views = 0;
  int32_t max_views = 0;
  int32_t multiple = 1;  ///< sides of the input are multiples of this
  std::array<float, 3> mean{};
  std::array<float, 3> std{};
  Resize resize = Resize::kFit;
  float pad_value = 0;      ///< of x / 255, before mean and std
  double pixel_center = 0;  ///< coordinate of the first pixel's centre in the model's intrinsics
  bool metric = false;      ///< lengths are metres
  bool takes_features = false;    ///< of an encoder, in place of images
  std::string encoder;            ///< identity of that encoder or, of kind encoder, its own
  std::vector<PeakMemory> peaks;  ///< empty: not stated
};

/// Value of a metadata key, without value where the file does not have it.
using MetadataLookup = std::function<std::optional<std::string>(const std::string& key)>;

/// @param path of the model, for messages
/// @throws OnnxError (UNISIM_ONNX_BAD_MODEL) naming the first key that is missing or wrong
Contract read_contract(const std::string& path, const MetadataLookup& lookup);

}  // namespace unisim::onnx
