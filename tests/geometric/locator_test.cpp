// SPDX-License-Identifier: MIT
// Frames looked for in a map of more places than one look has time for.
#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "drivers/geometric/places/orb.hpp"
#include "drivers/geometric/places/vlad.hpp"
#include "tests/geometric/map_bytes.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

constexpr int kKeyframeStride = 2;
constexpr int kSteps = 40;    // of the walk that is looked for
constexpr int kBehind = 160;  // of a walk that sees the other half of the room

CameraPlace behind(int step) {
  CameraPlace place = walk(step);
  const Eigen::Matrix3d about = Eigen::AngleAxisd(3.1, Eigen::Vector3d::UnitY()).matrix();
  place.R = about * place.R;
  place.center = about * place.center;
  return place;
}

/// A map of both walks, in two segments.
MapBytes map_of_both() {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  for (int step = 0; step < kSteps; ++step)
    run.show(render_room(walk(step)), step % kKeyframeStride == 0);
  const GrayImage black(static_cast<size_t>(kWidth) * kHeight, 0);
  for (int k = 0; k < 30; ++k) run.show(black, k % kKeyframeStride == 0);
  for (int step = 0; step < kBehind; ++step) {
    run.show(render_room(behind(step)), step % kKeyframeStride == 0);
  }
  REQUIRE(run.table()->finish(run.table()) == UNISIM_PREDICTION_OK);
  REQUIRE(run.info().restarts == 1);
  return save(run.table());
}

/// The keyframes of the first walk look like nothing on earth. @return how many
int spoil_descriptors(MapBytes* map) {
  Orb orb;
  orb.open(cv::Size(kWidth, kHeight), unisim_image{});
  OrbFeatureSet features;
  std::array<int8_t, kVladSize> descriptor{};
  int spoilt = 0;
  for (int step = 0; step < kSteps; step += kKeyframeStride) {
    GrayImage image = render_room(walk(step));
    orb.describe(cv::Mat(kHeight, kWidth, CV_8UC1, image.data()), &features);
    REQUIRE(describe_image(features.descriptor, descriptor.data()));
    const auto* bytes = reinterpret_cast<const uint8_t*>(descriptor.data());
    const auto found = std::search(map->begin(), map->end(), bytes, bytes + descriptor.size());
    if (found == map->end()) continue;
    ++spoilt;
    for (size_t k = 0; k < descriptor.size(); ++k) {
      found[static_cast<std::ptrdiff_t>(k)] = static_cast<uint8_t>(-descriptor[k]);
    }
  }
  return spoilt;
}

}  // namespace

TEST_CASE("a frame that its likeliest places do not show is looked for in the next ones") {
  MapBytes map = map_of_both();
  const bool spoil = GENERATE(false, true);
  if (spoil) REQUIRE(spoil_descriptors(&map) >= 6);
  PredictorRun run(default_config());
  load(run.table(), map);
  const GrayImage image = render_room(walk(21));
  unisim_location location{};
  // All places before it are those of the other walk: a dozen a frame.
  int frames = 1;
  while (locate(run.table(), image, &location) != UNISIM_PREDICTION_OK && frames < 5) ++frames;
  CHECK(frames == (spoil ? 2 : 1));
  CHECK(location.keyframe_id < kSteps / kKeyframeStride);
}

}  // namespace unisim::geometric::test
