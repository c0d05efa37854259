// SPDX-License-Identifier: MIT
// What a run without a start says: what was seen, and only advice that fits it.
#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace unisim::geometric::test {

namespace {

using Change = std::function<void(GrayImage*)>;

constexpr int kStartFrames = 40;
constexpr int kStartStride = 2;

/// Random squares of 10 pixels.
GrayImage squares(unsigned seed) {
  constexpr int kSide = 10;
  std::mt19937 random(seed);
  GrayImage out(static_cast<std::size_t>(kWidth) * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool corner = x % kSide == 0 && y % kSide == 0;
      out[at(x, y)] = corner ? static_cast<std::uint8_t>(random() % 256)
                             : out[at(x / kSide * kSide, y / kSide * kSide)];
    }
  }
  return out;
}

/// The line after a walk whose images were changed.
std::string report_of(const Change& change) {
  PredictorRun run(default_config());
  for (int step = 0; step < kStartFrames; ++step) {
    GrayImage image = render_room(walk(step));
    change(&image);
    run.show(image, step % kStartStride == 0);
  }
  const unisim_predictor_info info = run.info();
  INFO("focal length " << info.focal_px);
  REQUIRE(info.initialised == 0);
  REQUIRE(info.no_start != nullptr);
  return info.no_start;
}

void darken(GrayImage* image) {
  for (auto& value : *image) value = static_cast<std::uint8_t>(value / 80);
}

void brighten(GrayImage* image) {
  for (auto& value : *image) value = static_cast<std::uint8_t>(240 + value / 80);
}

void flatten(GrayImage* image) {
  for (auto& value : *image) value = static_cast<std::uint8_t>(120 + value / 80);
}

void cover_most(GrayImage* image) {
  static const GrayImage text = squares(3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < 3 * kWidth / 4; ++x) (*image)[at(x, y)] = text[at(x, y)];
  }
}

void show_two_eyes(GrayImage* image) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2; ++x) {
      (*image)[at(kWidth / 2 + x, y)] = (*image)[at(std::min(x + 6, kWidth / 2 - 1), y)];
    }
  }
}

}  // namespace

TEST_CASE("before the first frame there is nothing to tell of a start") {
  CHECK(PredictorRun(default_config()).info().no_start == nullptr);
}

TEST_CASE("a run without a start says how much was seen") {
  const std::string line = report_of(darken);
  INFO(line);
  CHECK(has(line, "no start: 40 frames of 320x240, 20 keyframes"));
  CHECK(has(line, "grey levels"));
  CHECK(has(line, "features per keyframe"));
  CHECK(has(line, "refused: 19 too few features"));
}

TEST_CASE("images that cannot be used are named as such") {
  const auto check = [](const Change& change, const char* advice) {
    INFO(advice);
    const std::string line = report_of(change);
    INFO(line);
    CHECK(has(line, advice));
    CHECK_FALSE(has(line, "sideways"));
  };
  check(darken, "too dark");
  check(brighten, "too bright");
  check(flatten, "hardly any contrast");
  check(cover_most, "--mask");
}

TEST_CASE("two eyes side by side are told, also where a start is found") {
  PredictorRun run(default_config());
  for (int step = 0; step < 60; ++step) {
    GrayImage image = render_room(walk(step));
    show_two_eyes(&image);
    run.show(image, step % 3 == 0);
  }
  std::vector<int32_t> ids(16);
  std::iota(ids.begin(), ids.end(), 0);
  unisim_window_prediction window{};
  const int answer = run.table()->multi_view(run.table(), ids.data(), 16, &window);
  const bool started = run.info().initialised != 0;
  REQUIRE(answer == (started ? UNISIM_PREDICTION_OK : UNISIM_PREDICTION_REJECTED));
  const char* line = started ? window.remark : run.info().no_start;
  REQUIRE(line != nullptr);
  CHECK(has(line, "halves look alike"));
}

TEST_CASE("images that have nothing to do with each other ask for a smaller stride") {
  PredictorRun run(default_config());
  for (unsigned step = 0; step < 10; ++step) run.show(squares(step), true);
  const std::string line = run.info().no_start;
  INFO(line);
  CHECK(has(line, "lower --stride"));
  CHECK_FALSE(has(line, "sideways"));
}

TEST_CASE("one keyframe is too few to start") {
  PredictorRun run(default_config());
  run.show_path(walk, 10, 100);
  const std::string line = run.info().no_start;
  INFO(line);
  CHECK(has(line, "1 keyframe,"));
  CHECK(has(line, "lower --stride"));
  CHECK_FALSE(has(line, "refused"));
}

TEST_CASE("images too small are counted and their size is told") {
  PredictorRun run(default_config());
  const GrayImage small(static_cast<std::size_t>(64) * 48, 90);
  unisim_frame frame{};
  frame.image = {small.data(), 64, 48, 64, UNISIM_PIXEL_GRAY8};
  unisim_motion motion{};
  for (int i = 0; i < 3; ++i) {
    CHECK(run.table()->observe(run.table(), &frame, &motion) == UNISIM_PREDICTION_REJECTED);
  }
  const std::string line = run.info().no_start;
  INFO(line);
  CHECK(has(line, "3 frames left out"));
  CHECK(has(line, "64x48"));
  CHECK(has(line, "at least 64x64"));
}

TEST_CASE("a camera at rest and one that turns are told apart, and a start ends the telling") {
  PredictorRun rest(default_config());
  rest.show_path([](int) { return walk(7); }, kStartFrames, kStartStride);
  CHECK(has(rest.info().no_start, "refused: 19 not enough motion; not enough motion"));
  CHECK(rest.motion().reason == UNISIM_REASON_DUPLICATE);  // of the frame, before that of the start
  PredictorRun turned(default_config());
  turned.show_path(turn, 60, 3);
  CHECK(has(turned.info().no_start, "the camera only turned"));
  CHECK(turned.motion().reason == UNISIM_REASON_TURNED);
  PredictorRun moved(default_config());
  moved.show_path(walk, 60, 3);
  CHECK(moved.info().no_start == nullptr);
  CHECK(moved.motion().reason == UNISIM_REASON_NONE);
}

}  // namespace unisim::geometric::test
