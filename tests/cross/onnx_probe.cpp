// SPDX-License-Identifier: MIT
// Runs the small ONNX models and compares with their closed forms; for emulators, hence without
// Catch2.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "drivers/onnx/onnx.h"

namespace {

constexpr int32_t kWidth = 16;
constexpr int32_t kHeight = 12;
constexpr uint8_t kGray = 51;  // a fifth of white
int failures = 0;

void expect(const char* what, double found, double wanted) {
  const bool good = std::abs(found - wanted) < 1e-5;
  if (!good) ++failures;
  std::printf("%s %.7f%s\n", what, found, good ? "" : " is wrong");
}

unisim_image gray_image() {
  static const std::vector<uint8_t> pixels(kWidth * kHeight, kGray);
  return {pixels.data(), kWidth, kHeight, kWidth, UNISIM_PIXEL_GRAY8};
}

void probe_window(unisim_predictor* predictor) {
  for (int32_t id = 0; id < 5; ++id) {
    const unisim_frame frame{id, id, gray_image()};
    unisim_motion motion{};
    predictor->observe(predictor, &frame, &motion);
    predictor->keyframe(predictor, &frame, id);
  }
  const int32_t ids[] = {0, 1, 2, 3, 4};
  unisim_window_prediction window{};
  expect("window status", predictor->multi_view(predictor, ids, 5, &window), UNISIM_PREDICTION_OK);
  if (failures > 0) return;
  // See closed_form() in tests/onnx/make_models.py.
  expect("x of view 4", window.T_window_kf[4].t[0], 4);
  expect("z of view 4", window.T_window_kf[4].t[2], 2);
  expect("turn of view 4", std::abs(window.T_window_kf[4].q[2]), std::sin(0.2));
  expect("depth", static_cast<double>(window.depth[4].depth[100]), 1.2);
  expect("focal length", window.focal_px, std::sqrt(2000.0));
}

void probe_descriptor(const unisim_onnx_config& config, const std::string& path) {
  char message[512] = "";
  unisim_onnx_descriptor* model =
      unisim_onnx_descriptor_open(&config, path.c_str(), nullptr, message, sizeof message);
  const unisim_image image = gray_image();
  const float* values = nullptr;
  if (model == nullptr || unisim_onnx_descriptor_embed(model, &image, &values) != 0) {
    std::printf("descriptor: %s\n", message);
    ++failures;
    return;
  }
  expect("descriptor", static_cast<double>(values[0]), 0.4 / std::sqrt(3 * 0.16 + 1));
  unisim_onnx_descriptor_close(model);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string folder = argv[1];
  const std::string file = folder + "/multiview.onnx";
  unisim_onnx_config config;
  unisim_onnx_config_init(&config, sizeof config);
  config.threads = 1;
  config.library = argv[2];
  config.model_pair = file.c_str();
  char message[512] = "";
  unisim_predictor* predictor = unisim_onnx_create(&config, nullptr, message, sizeof message);
  if (predictor == nullptr) {
    std::printf("%s\n", message);
    return 1;
  }
  std::printf("%s\n", unisim_onnx_note(predictor, 0));
  probe_window(predictor);
  predictor->destroy(predictor);
  probe_descriptor(config, folder + "/descriptor.onnx");
  return failures > 0 ? 1 : 0;
}
