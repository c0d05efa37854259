// SPDX-License-Identifier: MIT
// A mask hides what goes with the camera: no feature and no depth there.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace unisim::geometric::test {

namespace {

constexpr int kHidden = kWidth / 3;

/// A chequered overlay over the left third, which goes with the camera.
GrayImage with_overlay(GrayImage image) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kHidden; ++x)
      image[at(x, y)] = static_cast<std::uint8_t>((x / 7 * 5 + y / 9 * 3) % 4 * 80);
  }
  return image;
}

GrayImage left_third_black() {
  GrayImage mask(static_cast<std::size_t>(kWidth) * kHeight, 255);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kHidden; ++x) mask[at(x, y)] = 0;
  }
  return mask;
}

unisim_geometric_config masked(const GrayImage& mask) {
  unisim_geometric_config config = default_config();
  config.mask = {mask.data(), kWidth, kHeight, kWidth, UNISIM_PIXEL_GRAY8};
  return config;
}

void walk_with_overlay(PredictorRun* run) {
  for (int step = 0; step < 60; ++step)
    run->show(with_overlay(render_room(walk(step))), step % 3 == 0);
}

std::vector<CameraPlace> true_places() {
  std::vector<CameraPlace> places;
  for (int step = 12; step < 60; step += 3) places.push_back(walk(step));
  return places;
}

}  // namespace

TEST_CASE("an overlay over a third of the image does no harm where a mask hides it") {
  PredictorRun bare(default_config());
  walk_with_overlay(&bare);
  const std::vector<unisim_sim3> disturbed = bare.window(4, 16);

  GrayImage mask = left_third_black();
  PredictorRun run(masked(mask));
  mask.assign(mask.size(), 0);  // the predictor has its own copy
  walk_with_overlay(&run);
  const std::vector<unisim_sim3> poses = run.window(4, 16);
  REQUIRE(poses.size() == 16);
  const double error = relative_error(poses, true_places());
  CHECK(error < 0.03);
  CHECK((disturbed.size() != 16 || relative_error(disturbed, true_places()) > error));
}

TEST_CASE("a masked part of the image has no depth") {
  const GrayImage mask = left_third_black();
  PredictorRun run(masked(mask));
  walk_with_overlay(&run);
  REQUIRE(run.pair(run.keyframes() - 2) == UNISIM_PREDICTION_OK);
  const unisim_depth_map& depth = run.last_pair().depth_j;
  int seen = 0;
  for (int32_t y = 0; y < depth.height; ++y) {
    for (int32_t x = 0; x < depth.width; ++x) {
      const float value = depth.depth[y * depth.width + x];
      if (3 * x + 3 <= depth.width) CHECK(value == 0.0F);
      seen += value > 0 ? 1 : 0;
    }
  }
  CHECK(seen > depth.width * depth.height / 4);
}

TEST_CASE("a mask of another size than the images ends the run with both sizes") {
  const GrayImage mask(static_cast<std::size_t>(160) * 120, 255);
  unisim_geometric_config config = default_config();
  config.mask = {mask.data(), 160, 120, 160, UNISIM_PIXEL_GRAY8};
  PredictorRun run(config);
  CHECK(run.show(render_room(walk(0)), false) == UNISIM_PREDICTION_FAILED);
  CHECK(has(run.table()->message(run.table()), "160x120"));
  CHECK(has(run.table()->message(run.table()), "320x240"));
  config.mask.format = UNISIM_PIXEL_BGR8;
  char message[256] = "";
  CHECK(unisim_geometric_create(&config, message, sizeof message) == nullptr);
  CHECK(has(message, "mask"));
}

TEST_CASE("a configuration from before the mask and a longer one with a zero tail are taken") {
  struct Longer {
    unisim_geometric_config known;
    int64_t more;
  } config = {default_config(), 0};
  char message[256] = "";
  const auto taken = [&](size_t size) {
    config.known.struct_size = static_cast<uint32_t>(size);
    unisim_predictor* made = unisim_geometric_create(&config.known, message, sizeof message);
    if (made != nullptr) made->destroy(made);
    return made != nullptr;
  };
  CHECK(taken(offsetof(unisim_geometric_config, mask)));
  CHECK(taken(sizeof config));
  config.more = 1;
  CHECK_FALSE(taken(sizeof config));
  CHECK(has(message, "struct_size"));
}

}  // namespace unisim::geometric::test
