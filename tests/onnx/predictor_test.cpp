// SPDX-License-Identifier: MIT
// Predictions of models whose outputs are known in closed form; see make_models.py.
#include <cmath>

#include "tests/onnx/predictor_fixture.hpp"

using namespace unisim::testing;

namespace {

constexpr int32_t kWidth = 16;
constexpr int32_t kHeight = 12;

/// The model's centre of view k: A (1 + k, ...) re-anchored: R_0^T (c_k - c_0), R_0 = 90 deg about
/// x.
void check_pose(const unisim_sim3& pose, int32_t k) {
  CHECK(pose.s == 1.0);
  CHECK(pose.t[0] == Approx(k).margin(1e-6));
  CHECK(pose.t[1] == Approx(0).margin(1e-6));
  CHECK(pose.t[2] == Approx(0.5 * k).margin(1e-6));
  CHECK(std::abs(pose.q[2]) == Approx(std::sin(0.05 * k)).margin(1e-6));
  CHECK(std::abs(pose.q[3]) == Approx(std::cos(0.05 * k)).margin(1e-6));
  CHECK(pose.q[2] * pose.q[3] >= 0);
}

void check_depth(const unisim_depth_map& map, Image image) {
  REQUIRE(map.width == kWidth);
  REQUIRE(map.height == kHeight);
  for (int32_t i = 0; i < kWidth * kHeight; ++i) {
    const int32_t x = i % kWidth;
    const int32_t y = i / kWidth;
    const double mean = (image.at(x, y, 0) + image.at(x, y, 1) + image.at(x, y, 2)) / 765.0;
    CHECK(map.depth[i] == Approx(1 + mean).epsilon(1e-5));
    CHECK(map.confidence[i] >= 0);
    CHECK(map.confidence[i] <= 1);
  }
}

}  // namespace

TEST_CASE("a pair has the closed-form pose, depth and focal length, from either kind of model") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const std::string window = model_file("multiview.onnx");
  unisim_onnx_config config = test_config();
  config.model_window = window.c_str();
  for (const char* model : {"pair.onnx", "multiview.onnx", "split.onnx"}) {
    const Opened opened = open_model(model, config);
    INFO(opened.message);
    REQUIRE(opened.predictor != nullptr);
    unisim_predictor* predictor = opened.predictor.get();
    const std::vector<Image> views = colourful_images(kWidth, kHeight, 3);
    add_keyframes(predictor, views);
    unisim_pair_prediction pair{};
    REQUIRE(predictor->two_view(predictor, 1, 2, &pair) == UNISIM_PREDICTION_OK);
    check_pose(pair.T_i_j, 1);
    check_depth(pair.depth_i, views[1]);
    check_depth(pair.depth_j, views[2]);
    CHECK(pair.focal_px == Approx(std::sqrt(40.0 * 50.0)));
    CHECK(pair.center_sigma == 0);
  }
}

TEST_CASE("a window has the closed-form poses, also of a model with more views than it") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  for (const char* model : {"multiview.onnx", "eight_views.onnx", "split.onnx"}) {
    const Opened opened = open_model(model);
    REQUIRE(opened.predictor != nullptr);
    unisim_predictor* predictor = opened.predictor.get();
    const std::vector<Image> views = colourful_images(kWidth, kHeight, 6);
    add_keyframes(predictor, views);
    const int32_t ids[] = {0, 1, 2, 3, 4};
    unisim_window_prediction window{};
    REQUIRE(predictor->multi_view(predictor, ids, 5, &window) == UNISIM_PREDICTION_OK);
    REQUIRE(window.count == 5);
    for (int32_t k = 0; k < 5; ++k) {
      CHECK(window.keyframe_ids[k] == k);
      check_pose(window.T_window_kf[k], k);
      check_depth(window.depth[k], views[static_cast<size_t>(k)]);
    }
  }
}

TEST_CASE("a pair stays valid while a window is predicted") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_model("multiview.onnx");
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  const std::vector<Image> views = colourful_images(kWidth, kHeight, 4);
  add_keyframes(predictor, views);
  unisim_pair_prediction pair{};
  REQUIRE(predictor->two_view(predictor, 2, 3, &pair) == UNISIM_PREDICTION_OK);
  const int32_t ids[] = {0, 1, 2};
  unisim_window_prediction window{};
  REQUIRE(predictor->multi_view(predictor, ids, 3, &window) == UNISIM_PREDICTION_OK);
  check_depth(pair.depth_j, views[3]);
}

TEST_CASE("a window larger than the model takes is refused with what to do") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_model("eight_views.onnx");
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  CHECK(unisim_onnx_window_size(predictor) == 8);
  add_keyframes(predictor, colourful_images(kWidth, kHeight, 9));
  const int32_t ids[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  unisim_window_prediction window{};
  CHECK(predictor->multi_view(predictor, ids, 9, &window) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::string(predictor->window_message(predictor)).find("window_size") != std::string::npos);
}

TEST_CASE("a keyframe that has left the ring is named") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_model("multiview.onnx");
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  add_keyframes(predictor, colourful_images(kWidth, kHeight, 40));
  unisim_pair_prediction pair{};
  CHECK(predictor->two_view(predictor, 0, 1, &pair) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::string(predictor->message(predictor)) == "keyframe 0 is not kept any more");
}

TEST_CASE("an image that does not fit is left out, the next one goes on") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_model("multiview.onnx");
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  add_keyframes(predictor, colourful_images(kWidth, kHeight, 2));
  const Image other = colourful(20, 12, 0);
  unisim_frame frame{};
  frame.index = 2;
  frame.image = other.view;
  unisim_motion motion{};
  CHECK(predictor->observe(predictor, &frame, &motion) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::string(predictor->message(predictor)).find("16x12 to 20x12") != std::string::npos);
  frame.image.data = nullptr;
  CHECK(predictor->observe(predictor, &frame, &motion) == UNISIM_PREDICTION_REJECTED);
  unisim_pair_prediction pair{};
  CHECK(predictor->two_view(predictor, 0, 1, &pair) == UNISIM_PREDICTION_OK);
}

TEST_CASE("every keyframe_interval-th frame is advised as keyframe") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  unisim_onnx_config config = test_config();
  config.keyframe_interval = 3;
  const Opened opened = open_model("multiview.onnx", config);
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  const Image image = colourful(kWidth, kHeight, 0);
  int32_t keyframes = 0;
  for (int64_t index = 0; index < 10; ++index) {
    unisim_frame frame{index, index, image.view};
    unisim_motion motion{};
    REQUIRE(predictor->observe(predictor, &frame, &motion) == UNISIM_PREDICTION_OK);
    CHECK(motion.keyframe_advice == (index % 3 == 0 ? 1 : -1));
    if (motion.keyframe_advice > 0) predictor->keyframe(predictor, &frame, keyframes++);
  }
}

TEST_CASE("a descriptor has unit length and the closed-form direction") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const unisim_onnx_config config = test_config();
  unisim_onnx_descriptor* model = unisim_onnx_descriptor_open(
      &config, model_file("descriptor.onnx").c_str(), nullptr, nullptr, 0);
  REQUIRE(model != nullptr);
  REQUIRE(unisim_onnx_descriptor_size(model) == 4);
  Image image(kWidth, kHeight, 3);
  for (int32_t i = 0; i < kWidth * kHeight; ++i) image.at(i % kWidth, i / kWidth, 2) = 255;
  const float* values = nullptr;
  REQUIRE(unisim_onnx_descriptor_embed(model, &image.view, &values) == UNISIM_PREDICTION_OK);
  CHECK(values[0] == Approx(2 / std::sqrt(5.0)).epsilon(1e-6));
  CHECK(values[1] == Approx(0).margin(1e-6));
  CHECK(values[2] == Approx(0).margin(1e-6));
  CHECK(values[3] == Approx(1 / std::sqrt(5.0)).epsilon(1e-6));
  unisim_onnx_descriptor_close(model);
}
