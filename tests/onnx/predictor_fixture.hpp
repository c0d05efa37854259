// SPDX-License-Identifier: MIT
// Predictors on the small models of this folder, and images for them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/onnx.h"
#include "drivers/predictor.h"
#include "tests/support/catch.hpp"

namespace unisim::testing {

std::string model_file(const std::string& name);

/// Why no test that runs a model can run here, "" when it can.
std::string missing_runtime();

#define UNISIM_SKIP_WITHOUT_RUNTIME()      \
  if (!missing_runtime().empty()) {        \
    WARN("skipped: " + missing_runtime()); \
    return;                                \
  }

unisim_onnx_config test_config();

struct Closed {
  void operator()(unisim_predictor* predictor) const { predictor->destroy(predictor); }
};
using Predictor = std::unique_ptr<unisim_predictor, Closed>;

/// What creation answered.
struct Opened {
  Predictor predictor;  ///< NULL on failure
  int32_t problem = 0;
  std::string message;
};

/// @param model file name in models/, or a path
Opened open_model(const std::string& model, const unisim_onnx_config& config = test_config());

/// A model, and an encoder that need not lie beside it.
Opened open_with_encoder(const std::string& model, const std::string& encoder);

/// Owns its pixels.
struct Image {
  Image(int32_t width, int32_t height, int32_t channels)
      : pixels(static_cast<size_t>(width) * static_cast<size_t>(height * channels)),
        view{pixels.data(), width, height, width * channels, channels} {}
  uint8_t& at(int32_t x, int32_t y, int32_t channel = 0) {
    const int32_t index = y * view.stride + x * view.format + channel;
    return pixels[static_cast<size_t>(index)];
  }
  std::vector<uint8_t> pixels;
  unisim_image view;
};

/// BGR, every pixel another colour that depends on the seed.
Image colourful(int32_t width, int32_t height, int32_t seed);

/// So many of them, seeds 0, 1, 2 ...
std::vector<Image> colourful_images(int32_t width, int32_t height, int32_t count);

/// Hands images to a predictor as keyframes 0, 1, 2 ...
void add_keyframes(unisim_predictor* predictor, const std::vector<Image>& images);

}  // namespace unisim::testing
