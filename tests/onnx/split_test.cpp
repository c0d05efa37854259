// SPDX-License-Identifier: MIT
// Models in two files: an encoder that sees each keyframe once, and what takes its features.
#include <algorithm>
#include <filesystem>

#include "tests/onnx/predictor_fixture.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

constexpr int32_t kViewWidth = 16;
constexpr int32_t kViewHeight = 12;

void require_refusal(const Opened& opened, const std::string& part) {
  INFO(opened.message);
  CHECK(opened.predictor == nullptr);
  CHECK(opened.problem == UNISIM_ONNX_BAD_MODEL);
  CHECK(has(opened.message, part));
  CHECK_FALSE(has(opened.message, "\n"));
}

/// Window 0..4 of a model, flat.
std::vector<double> window_of(const std::string& model) {
  const Opened opened = open_model(model);
  INFO(opened.message);
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  add_keyframes(predictor, colourful_images(kViewWidth, kViewHeight, 5));
  const int32_t ids[] = {0, 1, 2, 3, 4};
  unisim_window_prediction window{};
  REQUIRE(predictor->multi_view(predictor, ids, 5, &window) == UNISIM_PREDICTION_OK);
  std::vector<double> flat;
  for (int32_t k = 0; k < 5; ++k) {
    flat.insert(flat.end(), window.T_window_kf[k].q, window.T_window_kf[k].q + 4);
    flat.insert(flat.end(), window.T_window_kf[k].t, window.T_window_kf[k].t + 3);
    const int32_t pixels = window.depth[k].width * window.depth[k].height;
    for (int32_t i = 0; i < pixels; ++i) {
      flat.push_back(double{window.depth[k].depth[i]});
      flat.push_back(double{window.depth[k].confidence[i]});
    }
  }
  return flat;
}

}  // namespace

TEST_CASE("a model in two files predicts what it does in one") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const std::vector<double> whole = window_of("multiview.onnx");
  REQUIRE_FALSE(whole.empty());
  CHECK(window_of("split.onnx") == whole);
}

TEST_CASE("each keyframe is encoded once, whatever pairs and windows ask for") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const std::string window_model = model_file("split.onnx");
  const std::string encoder = model_file("split.encoder.onnx");
  for (const char* pair_model : {"split.onnx", "split_pair.onnx"}) {
    unisim_onnx_config config = test_config();
    config.model_window = window_model.c_str();
    config.model_encoder = encoder.c_str();
    const Opened opened = open_model(pair_model, config);
    INFO(pair_model << " " << opened.message);
    REQUIRE(opened.predictor != nullptr);
    unisim_predictor* predictor = opened.predictor.get();
    CHECK(unisim_onnx_encoder_runs(predictor) == 0);
    add_keyframes(predictor, colourful_images(kViewWidth, kViewHeight, 7));
    const int32_t ids[] = {0, 1, 2, 3, 4, 5, 6};
    unisim_pair_prediction pair{};
    unisim_window_prediction window{};
    for (int32_t k = 0; k < 6; ++k) {
      CHECK(predictor->two_view(predictor, k, k + 1, &pair) == UNISIM_PREDICTION_OK);
    }
    CHECK(predictor->multi_view(predictor, ids, 5, &window) == UNISIM_PREDICTION_OK);
    CHECK(predictor->multi_view(predictor, ids + 2, 5, &window) == UNISIM_PREDICTION_OK);
    CHECK(unisim_onnx_encoder_runs(predictor) == 7);
  }
}

TEST_CASE("what is kept of the keyframes is told and counted") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_model("split.onnx");
  REQUIRE(opened.predictor != nullptr);
  std::string notes;
  for (int32_t i = 0; unisim_onnx_note(opened.predictor.get(), i) != nullptr; ++i) {
    notes += std::string(unisim_onnx_note(opened.predictor.get(), i)) + "\n";
  }
  INFO(notes);
  CHECK(has(notes, "features of the newest 28 keyframes are kept: 0.041 MB"));
  CHECK(has(notes, "test encoder encoder: 1 view(s)"));
  unisim_predictor_info info{};
  opened.predictor->info(opened.predictor.get(), &info);
  CHECK(info.state_bytes >=
        20 * kViewHeight * 2 * kViewWidth * static_cast<int64_t>(sizeof(float)));
}

TEST_CASE("a keyframe whose features are not finite is named, the next ones go on") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_with_encoder("split.onnx", "split_nan.encoder.onnx");
  INFO(opened.message);
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  std::vector<Image> views = colourful_images(kViewWidth, kViewHeight, 5);
  for (Image& view : views) view.at(0, 0, 2) = 0;
  views[1].at(0, 0, 2) = 255;
  add_keyframes(predictor, views);
  unisim_pair_prediction pair{};
  CHECK(predictor->two_view(predictor, 0, 1, &pair) == UNISIM_PREDICTION_REJECTED);
  CHECK(std::string(predictor->message(predictor)) ==
        "keyframe 1 could not be encoded: features are not finite");
  CHECK(predictor->two_view(predictor, 2, 3, &pair) == UNISIM_PREDICTION_OK);
}

TEST_CASE("an encoder that is not the model's is refused by what differs") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const std::string encoder = "split.encoder.onnx";
  require_refusal(open_with_encoder("split_other.onnx", encoder),
                  "split_other.onnx: unisim.encoder is bad1, but");
  require_refusal(open_with_encoder("split_mean.onnx", encoder), "unisim.mean is not that of");
  require_refusal(open_with_encoder("split_shape.onnx", encoder),
                  "input features has shape (1,V,12,33), but");
  require_refusal(open_with_encoder("split.onnx", "multiview.onnx"),
                  "multiview.onnx: is not of kind encoder");
  require_refusal(open_model("split.encoder.onnx"), "is an encoder; give the model");
}

TEST_CASE("an encoder that is absent or in nobody's service is named") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  require_refusal(open_model("split_shape.onnx"), "split_shape.encoder.onnx is no file");
  const Opened idle = open_with_encoder("multiview.onnx", "split.encoder.onnx");
  CHECK(idle.problem == UNISIM_ONNX_BAD_CONFIG);
  CHECK(has(idle.message, "onnx.model_encoder: no model takes"));
}

TEST_CASE("a model with the wrong input for what it says is refused") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  // The same file says that it takes images: only its metadata is changed, byte for byte.
  const TempFolder folder;
  std::string text = read_file(model_file("split.onnx"));
  const size_t at = text.find("unisim.input");
  REQUIRE(at != std::string::npos);
  text.replace(at, 12, "unisim.other");
  require_refusal(open_model(folder.write("unsaid.onnx", text)),
                  "takes input \"features\", the contract has \"images\" alone");
}
