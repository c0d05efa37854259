// SPDX-License-Identifier: MIT
// Descriptors of places: what they tell apart, and the list of keyframes that goes by them.
#include <algorithm>
#include <array>
#include <opencv2/core.hpp>

#include "drivers/geometric/places/loop_book.hpp"
#include "drivers/geometric/places/orb.hpp"
#include "drivers/geometric/places/place_list.hpp"
#include "drivers/geometric/places/vlad.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

using Descriptor = std::array<int8_t, kVladSize>;

cv::Mat gray_of(GrayImage* image) { return {kHeight, kWidth, CV_8UC1, image->data()}; }

OrbFeatureSet features_of(const CameraPlace& place) {
  GrayImage image = render_room(place);
  Orb orb;
  orb.open(cv::Size(kWidth, kHeight), unisim_image{});
  OrbFeatureSet out;
  orb.describe(gray_of(&image), &out);
  return out;
}

Descriptor descriptor_of(const CameraPlace& place) {
  Descriptor out;
  REQUIRE(describe_image(features_of(place).descriptor, out.data()));
  return out;
}

int dot(const Descriptor& a, const Descriptor& b) {
  int sum = 0;
  for (size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// Looks at another wall.
CameraPlace turned_away() {
  CameraPlace place;
  place.R = Eigen::AngleAxisd(1.6, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return place;
}

}  // namespace

TEST_CASE("images of one place have more alike descriptors than images of two") {
  const Descriptor here = descriptor_of(walk(0));
  const Descriptor near_by = descriptor_of(walk(6));
  const Descriptor elsewhere = descriptor_of(turned_away());
  CHECK(dot(here, near_by) > 2 * dot(here, elsewhere));
  CHECK(dot(here, descriptor_of(walk(0))) == dot(here, here));
  const auto furthest = std::minmax_element(here.begin(), here.end());
  CHECK(*furthest.second <= 127);
  CHECK(*furthest.first >= -127);
}

TEST_CASE("an image without features has no descriptor") {
  GrayImage black(static_cast<size_t>(kWidth) * kHeight, 0);
  Orb orb;
  orb.open(cv::Size(kWidth, kHeight), unisim_image{});
  OrbFeatureSet features;
  orb.describe(gray_of(&black), &features);
  Descriptor descriptor;
  CHECK(features.point.empty());
  CHECK_FALSE(describe_image(features.descriptor, descriptor.data()));
}

TEST_CASE("features are spread over the image and not taken where the mask is black") {
  GrayImage image = render_room(walk(0));
  GrayImage look(static_cast<size_t>(kWidth) * kHeight, 255);
  for (int y = 0; y < kHeight; ++y) {
    std::fill_n(look.begin() + static_cast<ptrdiff_t>(y) * kWidth, kWidth / 2, uint8_t{0});
  }
  Orb orb;
  orb.open(cv::Size(kWidth, kHeight), {look.data(), kWidth, kHeight, kWidth, UNISIM_PIXEL_GRAY8});
  OrbFeatureSet features;
  orb.describe(gray_of(&image), &features);
  REQUIRE(features.point.size() > 100);
  CHECK(features.point.size() <= kOrbFeatures);
  for (const cv::Point2f& at : features.point) CHECK(at.x >= kWidth / 2.0F - 3);
}

TEST_CASE("points are described at the scales at which they lie inside the image") {
  GrayImage image = render_room(walk(0));
  Orb orb;
  orb.open(cv::Size(kWidth, kHeight), unisim_image{});
  std::vector<OrbDescriptor> descriptors;
  std::vector<uint8_t> valid;
  orb.describe_points(gray_of(&image), {{160, 120}, {2, 2}}, &descriptors, &valid);
  REQUIRE(descriptors.size() == 2 * kOrbScales);
  CHECK(valid[0] == 7);
  CHECK(valid[1] == 0);
  CHECK(descriptors[0] != descriptors[2]);
}

TEST_CASE("the list of places forgets keyframes that leave the state") {
  PlaceList list(8);
  Descriptor descriptor;
  descriptor.fill(1);
  for (int32_t id = 0; id < 6; ++id) {
    descriptor[static_cast<size_t>(id)] = 100;
    list.add(id, descriptor.data());
  }
  CHECK(list.query(6, descriptor.data(), 1, 1, 9).size() == 6);
  list.keep({4, 5, 7});
  const auto& left = list.query(6, descriptor.data(), 1, 1, 9);
  REQUIRE(left.size() == 2);
  CHECK(std::min(left[0].id, left[1].id) == 4);
  CHECK(list.query(6, descriptor.data(), 2, 1, 9).size() == 1);
}

TEST_CASE("an observation added later stands in time order") {
  LandmarkMap map({8, 16, 4});
  const int32_t slot = map.add_landmark(0);
  for (const int32_t id : {0, 1, 2, 3}) {
    map.push_keyframe(id, 0);
    if (id == 1 || id == 3) map.observe(slot, cv::Point2f(static_cast<float>(id), 0));
  }
  CHECK(map.observe_in(2, slot, cv::Point2f(2, 0)));
  CHECK(map.observe_in(0, slot, cv::Point2f(0, 0)));
  CHECK_FALSE(map.observe_in(1, slot, cv::Point2f(9, 0)));
  std::vector<int32_t> order;
  std::vector<float> at;
  map.for_each_observation(slot, [&](const ObservationRef& ref, const Observation& seen) {
    order.push_back(ref.keyframe);
    at.push_back(seen.x);
  });
  CHECK(order == std::vector<int32_t>{0, 1, 2, 3});
  CHECK(at == std::vector<float>{0, 1, 2, 3});
  CHECK(map.landmark(slot).observations == 4);
  CHECK(map.landmark(slot).last.keyframe == 3);
}

namespace {

/// A state of posed keyframes on a line, with one placed landmark.
struct Line {
  Line() : state(default_config(), {16, 64, 8}) {
    state.median_depth = 1;
    slot = state.map.add_landmark(0);
    state.map.landmark(slot).state = LandmarkState::kPlaced;
    for (int32_t id = 0; id < 12; ++id) {
      Keyframe& keyframe = state.map.push_keyframe(id, 0);
      keyframe.posed = true;
      keyframe.pose.t.x() = -0.1 * id;
    }
  }
  /// Keyframe `id` found `off` beside where the state has it.
  PlaceFound found(int32_t id, double off) const {
    PlaceFound out;
    out.keyframe = 0;
    out.pose = state.map.keyframe(id).pose;
    out.pose.t.y() = off;
    out.matches.push_back({slot, state.map.landmark(slot).generation, cv::Point2f(5, 5)});
    return out;
  }
  State state;
  int32_t slot;
};

}  // namespace

TEST_CASE("a loop counts when a second keyframe soon after says the same") {
  const auto second = GENERATE(9, 11);
  const auto off = GENERATE(0.3, 0.5);
  Line line;
  LoopBook book;
  book.add(line.state, 5, line.found(5, 0.3));
  CHECK(book.hoping());
  CHECK_FALSE(book.waiting(0));
  book.add(line.state, second, line.found(second, off));
  const bool agree = second == 9 && off == 0.3;
  CHECK(book.waiting(0) == agree);
  CHECK_FALSE(book.waiting(1));
  std::vector<LoopObservation> observations;
  book.take(line.state, &observations);
  REQUIRE(observations.size() == (agree ? 2 : 0));
  if (agree) {
    CHECK(observations[0].keyframe == 5);
    CHECK(observations[1].keyframe == 9);
    CHECK(observations[0].landmark == line.slot);
  }
  CHECK_FALSE(book.waiting(0));
  CHECK(book.drop_unconfirmed(second + 9).size() == (agree ? 0 : 2));
  CHECK_FALSE(book.hoping());
}

}  // namespace unisim::geometric::test
