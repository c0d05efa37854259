// SPDX-License-Identifier: MIT
// Keyframes that are kept to be seen again.
#include <cstring>

#include "tests/onnx/predictor_fixture.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

// The ring holds a window and twelve more.
constexpr int32_t kBeyondTheRing = 40;

/// Keyframes, each described as a place.
std::vector<std::vector<int8_t>> add_places(unisim_predictor* predictor,
                                            const std::vector<Image>& images) {
  std::vector<std::vector<int8_t>> descriptors;
  for (size_t i = 0; i < images.size(); ++i) {
    unisim_frame frame{};
    frame.index = frame.timestamp_ns = static_cast<int64_t>(i);
    frame.image = images[i].view;
    frame.image.data = images[i].pixels.data();
    unisim_motion motion{};
    const auto id = static_cast<int32_t>(i);
    REQUIRE(predictor->observe(predictor, &frame, &motion) == UNISIM_PREDICTION_OK);
    REQUIRE(predictor->keyframe(predictor, &frame, id) == UNISIM_PREDICTION_OK);
    unisim_place_descriptor place{};
    REQUIRE(predictor->place_descriptor(predictor, id, &place) == UNISIM_PREDICTION_OK);
    CHECK(place.image_width == frame.image.width);
    CHECK(place.image_height == frame.image.height);
    descriptors.emplace_back(place.values, place.values + place.dimension);
  }
  return descriptors;
}

/// What a predictor says of two keyframes.
struct PairAnswer {
  std::vector<unisim_sim3> poses;
  std::vector<float> depth;
};

PairAnswer ask(unisim_predictor* predictor, int32_t a, int32_t b) {
  const int32_t ids[2] = {a, b};
  unisim_window_prediction window{};
  INFO(predictor->window_message(predictor));
  REQUIRE(predictor->multi_view(predictor, ids, 2, &window) == UNISIM_PREDICTION_OK);
  PairAnswer answer;
  answer.poses.assign(window.T_window_kf, window.T_window_kf + 2);
  for (int k = 0; k < 2; ++k) {
    const unisim_depth_map& map = window.depth[k];
    answer.depth.insert(answer.depth.end(), map.depth, map.depth + map.width * map.height);
  }
  return answer;
}

/// With a descriptor model.
Opened open_with_places(const std::string& model, const std::string& descriptor) {
  unisim_onnx_config config = test_config();
  const std::string path =
      descriptor.empty() || descriptor[0] == '/' ? descriptor : model_file(descriptor);
  config.model_descriptor = path.c_str();
  return open_model(model, config);
}

}  // namespace

TEST_CASE("a place is answered for as at first, long after its keyframe has left the ring") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  for (const char* model : {"multiview.onnx", "split.onnx"}) {
    const Opened opened = open_with_places(model, "descriptor.onnx");
    INFO(model << " " << opened.message);
    REQUIRE(opened.predictor != nullptr);
    unisim_predictor* predictor = opened.predictor.get();
    std::vector<Image> images = colourful_images(16, 12, 2);
    add_places(predictor, images);
    const PairAnswer at_first = ask(predictor, 0, 1);
    images = colourful_images(16, 12, kBeyondTheRing);
    for (int32_t i = 2; i < kBeyondTheRing; ++i) {
      unisim_frame frame{};
      frame.index = frame.timestamp_ns = i;
      frame.image = images[static_cast<size_t>(i)].view;
      frame.image.data = images[static_cast<size_t>(i)].pixels.data();
      REQUIRE(predictor->keyframe(predictor, &frame, i) == UNISIM_PREDICTION_OK);
    }
    const PairAnswer later = ask(predictor, 0, 1);
    CHECK(std::memcmp(later.poses.data(), at_first.poses.data(), 2 * sizeof(unisim_sim3)) == 0);
    CHECK(later.depth == at_first.depth);
    predictor->release_place(predictor, 0);
    const int32_t ids[2] = {0, 1};
    unisim_window_prediction window{};
    CHECK(predictor->multi_view(predictor, ids, 2, &window) == UNISIM_PREDICTION_REJECTED);
    CHECK(has(predictor->window_message(predictor), "keyframe 0 is not kept any more"));
  }
}

TEST_CASE("memory follows the places kept") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_with_places("multiview.onnx", "descriptor.onnx");
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  const auto bytes = [&] {
    unisim_predictor_info info{};
    predictor->info(predictor, &info);
    return info.state_bytes;
  };
  add_places(predictor, colourful_images(16, 12, 20));
  const int64_t with = bytes();
  for (int32_t id = 0; id < 20; ++id) predictor->release_place(predictor, id);
  CHECK(with - bytes() > 20 * 16 * 12 / 4);
  CHECK(with - bytes() < 20 * 16 * 12 * 3 * 2);
  predictor->release_place(predictor, 5);  // not kept: nothing
}

TEST_CASE("without a descriptor model images are told apart by their features") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_with_places("multiview.onnx", "");
  REQUIRE(opened.predictor != nullptr);
  const auto descriptors = add_places(opened.predictor.get(), colourful_images(160, 120, 2));
  CHECK(descriptors[0].size() == 1024);
  CHECK(descriptors[0] != std::vector<int8_t>(1024, 0));
}

TEST_CASE("the smallest images are described or refused, none ends the run") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  for (const int32_t width : {16, 40, 41, 64, 100}) {
    const Opened opened = open_with_places("multiview.onnx", "");
    REQUIRE(opened.predictor != nullptr);
    unisim_predictor* predictor = opened.predictor.get();
    add_keyframes(predictor, colourful_images(width, 3 * width / 4, 1));
    unisim_place_descriptor place{};
    INFO(width << " pixels: " << predictor->message(predictor));
    CHECK(predictor->place_descriptor(predictor, 0, &place) != UNISIM_PREDICTION_FAILED);
  }
}

TEST_CASE("an image with nothing to see is no place, and says so") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened opened = open_with_places("multiview.onnx", "");
  REQUIRE(opened.predictor != nullptr);
  unisim_predictor* predictor = opened.predictor.get();
  const std::vector<Image> blank(1, Image(160, 120, 3));
  add_keyframes(predictor, blank);
  unisim_place_descriptor place{};
  CHECK(predictor->place_descriptor(predictor, 0, &place) == UNISIM_PREDICTION_REJECTED);
  CHECK(has(predictor->message(predictor), "no features"));
}

TEST_CASE("a descriptor model that is none is refused in one line") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const Opened wrong = open_with_places("multiview.onnx", "pair.onnx");
  CHECK(wrong.predictor == nullptr);
  CHECK(wrong.problem == UNISIM_ONNX_BAD_MODEL);
  CHECK(has(wrong.message, "is not of kind descriptor"));
  const Opened absent = open_with_places("multiview.onnx", "/no/such.onnx");
  CHECK(absent.predictor == nullptr);
  CHECK(absent.problem == UNISIM_ONNX_BAD_MODEL);
  CHECK(has(absent.message, "/no/such.onnx"));
}
