// SPDX-License-Identifier: MIT
// A refused window is tried again without the views that are to blame.
#include <algorithm>

#include "tests/onnx/predictor_fixture.hpp"

using namespace unisim::testing;

namespace {

/// A predictor whose encoder is upset by some keyframes, with these and their pairs behind it.
struct Upset {
  Upset(int32_t keyframes, const std::vector<int32_t>& bad) {
    opened = open_with_encoder("split.onnx", "split_nan.encoder.onnx");
    INFO(opened.message);
    REQUIRE(opened.predictor != nullptr);
    for (int32_t i = 0; i < keyframes; ++i) {
      images.push_back(colourful(16, 12, i));
      const bool is_bad = std::find(bad.begin(), bad.end(), i) != bad.end();
      images.back().at(0, 0, 2) = is_bad ? 255 : 0;
    }
    add_keyframes(opened.predictor.get(), images);
    unisim_pair_prediction pair{};
    for (int32_t j = 1; j < keyframes; ++j) {
      opened.predictor->two_view(opened.predictor.get(), j - 1, j, &pair);
    }
  }

  int window(int32_t first, int32_t last, unisim_window_prediction* out) {
    std::vector<int32_t> ids;
    for (int32_t id = first; id <= last; ++id) ids.push_back(id);
    return opened.predictor->multi_view(opened.predictor.get(), ids.data(),
                                        static_cast<int32_t>(ids.size()), out);
  }

  std::string message() const { return opened.predictor->window_message(opened.predictor.get()); }

  Opened opened;
  std::vector<Image> images;
};

std::vector<int32_t> ids_of(const unisim_window_prediction& window) {
  return {window.keyframe_ids, window.keyframe_ids + window.count};
}

}  // namespace

TEST_CASE("a keyframe that upsets the model is left out of its window, with a remark") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  Upset upset(7, {3});
  unisim_window_prediction window{};
  REQUIRE(upset.window(0, 6, &window) == UNISIM_PREDICTION_OK);
  CHECK(ids_of(window) == std::vector<int32_t>{0, 1, 2, 4, 5, 6});
  REQUIRE(window.remark != nullptr);
  CHECK(std::string(window.remark) ==
        "taken without 3: keyframe 3 could not be encoded: features are not finite");
  // The model counts the views it gets: keyframe 4 is the fourth.
  CHECK(window.T_window_kf[3].t[0] == Approx(3).margin(1e-6));
}

TEST_CASE("the newest keyframe, which has one pair yet, is found too") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  Upset upset(5, {4});
  unisim_window_prediction window{};
  REQUIRE(upset.window(0, 4, &window) == UNISIM_PREDICTION_OK);
  CHECK(ids_of(window) == std::vector<int32_t>{0, 1, 2, 3});
}

TEST_CASE("a window with nothing to blame has no remark, one with too little left is refused") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  Upset upset(8, {5, 6, 7});
  unisim_window_prediction window{};
  REQUIRE(upset.window(0, 4, &window) == UNISIM_PREDICTION_OK);
  CHECK(window.count == 5);
  CHECK(window.remark == nullptr);
  CHECK(upset.window(5, 7, &window) == UNISIM_PREDICTION_REJECTED);
  CHECK(upset.message() == "keyframe 5 could not be encoded: features are not finite");
}
