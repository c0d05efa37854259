// SPDX-License-Identifier: MIT
// Predictors on the small models of this folder, and images for them.
#include "tests/onnx/predictor_fixture.hpp"

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/runtime.hpp"

namespace unisim::testing {

std::string model_file(const std::string& name) { return UNISIM_MODELS "/" + name; }

std::string missing_runtime() {
  try {
    onnx::Runtime::open("");
    return "";
  } catch (const onnx::OnnxError& error) {
    return error.what();
  }
}

unisim_onnx_config test_config() {
  unisim_onnx_config config;
  unisim_onnx_config_init(&config, sizeof config);
  config.threads = 1;
  return config;
}

Opened open_model(const std::string& model, const unisim_onnx_config& config) {
  const std::string path = model.find('/') == std::string::npos ? model_file(model) : model;
  unisim_onnx_config with_model = config;
  with_model.model_pair = path.c_str();
  Opened opened;
  char line[512] = "";
  opened.predictor.reset(unisim_onnx_create(&with_model, &opened.problem, line, sizeof line));
  opened.message = line;
  return opened;
}

Opened open_with_encoder(const std::string& model, const std::string& encoder) {
  unisim_onnx_config config = test_config();
  const std::string path = model_file(encoder);
  config.model_encoder = path.c_str();
  return open_model(model, config);
}

Image colourful(int32_t width, int32_t height, int32_t seed) {
  Image image(width, height, 3);
  for (int32_t y = 0; y < height; ++y) {
    for (int32_t x = 0; x < width; ++x) {
      for (int32_t c = 0; c < 3; ++c) {
        image.at(x, y, c) = static_cast<uint8_t>((x * 11 + y * 23 + c * 71 + seed * 37) % 256);
      }
    }
  }
  return image;
}

std::vector<Image> colourful_images(int32_t width, int32_t height, int32_t count) {
  std::vector<Image> images;
  images.reserve(static_cast<size_t>(count));
  for (int32_t seed = 0; seed < count; ++seed) images.push_back(colourful(width, height, seed));
  return images;
}

void add_keyframes(unisim_predictor* predictor, const std::vector<Image>& images) {
  for (size_t i = 0; i < images.size(); ++i) {
    unisim_frame frame{};
    frame.index = static_cast<int64_t>(i);
    frame.timestamp_ns = frame.index;
    frame.image = images[i].view;
    frame.image.data = images[i].pixels.data();
    unisim_motion motion{};
    REQUIRE(predictor->observe(predictor, &frame, &motion) == UNISIM_PREDICTION_OK);
    REQUIRE(predictor->keyframe(predictor, &frame, static_cast<int32_t>(i)) ==
            UNISIM_PREDICTION_OK);
  }
}

}  // namespace unisim::testing
