// SPDX-License-Identifier: MIT
// Two segments of the map that turn out to show one place.
#include <algorithm>

#include "drivers/geometric/map/join_segments.hpp"
#include "drivers/geometric/places/bridge_book.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

constexpr int kPoints = 20;
constexpr int32_t kFirst = 6;  // keyframe of segment 1

/// How segment 1's world lies to segment 0's.
WorldMove true_move() {
  WorldMove out;
  out.scale = 1.5;
  out.R = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  out.t = {0.3, -0.2, 1.0};
  return out;
}

/// Cameras on a line before a wall of landmarks, the first kFirst of them in segment 0, the others
/// in segment 1, whose world is another one. Each segment has landmarks of its own.
struct TwoSegments {
  TwoSegments() : state(default_config(), {16, 64, 32}) {
    state.size = cv::Size(kWidth, kHeight);
    state.intrinsics = Intrinsics::start(state.size, kFocal);
    state.median_depth = 4 / true_move().scale;
    for (int32_t segment = 0; segment < 2; ++segment) {
      for (int k = 0; k < kPoints; ++k) {
        slots[segment].push_back(state.map.add_landmark(segment));
        Landmark& mark = state.map.landmark(slots[segment].back());
        mark.state = LandmarkState::kPlaced;
        mark.position = point(k);
        if (segment == 1) mark.position = true_move().inverse().apply(mark.position);
      }
    }
    for (int32_t id = 0; id < 12; ++id) {
      const int32_t segment = id < kFirst ? 0 : 1;
      Keyframe& keyframe = state.map.push_keyframe(id, segment);
      keyframe.posed = true;
      keyframe.pose = pose(id);
      for (int k = 0; k < kPoints; ++k) {
        state.map.observe(slots[segment][static_cast<size_t>(k)], pixel(id, k));
      }
      if (segment == 1) keyframe.pose = true_move().inverse().apply(keyframe.pose);
    }
    state.segments = 2;
    state.enter(1);
  }
  static Eigen::Vector3d point(int k) {
    return {0.2 * (k % 5), 0.2 * (k / 5), 4.0 + 0.1 * (k % 3)};
  }
  static CameraPose pose(int32_t id) {
    CameraPose out;
    out.t.x() = -0.05 * id;
    return out;
  }
  cv::Point2f pixel(int32_t id, int k) const {
    Eigen::Vector2d at;
    REQUIRE(state.intrinsics.camera.project(pose(id).apply(point(k)), &at));
    return {static_cast<float>(at.x()), static_cast<float>(at.y())};
  }
  /// Keyframe `id` found in segment 0, `off` beside the truth.
  PlaceFound found(int32_t id, double off) const {
    PlaceFound out;
    out.keyframe = 2;
    out.pose = pose(id);
    out.pose.t.y() += off;
    for (int k = 0; k < kPoints; ++k) {
      const int32_t slot = slots[0][static_cast<size_t>(k)];
      out.matches.push_back({slot, state.map.landmark(slot).generation, pixel(id, k)});
    }
    return out;
  }
  State state;
  std::vector<int32_t> slots[2];
};

double apart(const CameraPose& a, const CameraPose& b) {
  return (a.center() - b.center()).norm() + (a.R - b.R).norm();
}

}  // namespace

TEST_CASE("segments are joined when three keyframes agree on how they lie") {
  const auto third = GENERATE(8, 9);
  const auto off = GENERATE(0.0, 2.0);
  TwoSegments world;
  BridgeBook book;
  SegmentJoin join;
  std::vector<LoopObservation> observations;
  book.add(world.state, 6, world.found(6, 0.0));
  book.add(world.state, 7, world.found(7, 0.0));
  CHECK(book.hoping());
  CHECK_FALSE(book.take(world.state, &join, &observations));
  book.add(world.state, third, world.found(third, off));
  REQUIRE(book.take(world.state, &join, &observations) == (off == 0.0));
  if (off != 0.0) return;
  CHECK_FALSE(book.hoping());
  CHECK(join.segment == 0);
  CHECK(observations.size() == 3 * kPoints);
  CHECK(std::is_sorted(
      observations.begin(), observations.end(),
      [](const LoopObservation& a, const LoopObservation& b) { return a.landmark < b.landmark; }));
  CHECK(join.move.inverse().scale == Approx(true_move().scale).epsilon(1e-6));

  join_segments(&world.state, 1, 0, join.move.inverse());
  CHECK(world.state.segment == 0);
  CHECK(world.state.segment_start == 0);
  CHECK(world.state.posed == 12);
  CHECK_FALSE(world.state.other_segments());
  CHECK(world.state.median_depth == Approx(4).epsilon(1e-6));
  for (int32_t id = 0; id < 12; ++id) {
    CHECK(world.state.map.keyframe(id).segment == 0);
    CHECK(apart(world.state.map.keyframe(id).pose, TwoSegments::pose(id)) < 1e-5);
  }
  for (int k = 0; k < kPoints; ++k) {
    const Landmark& mark = world.state.map.landmark(world.slots[1][static_cast<size_t>(k)]);
    CHECK(mark.segment == 0);
    CHECK((mark.position - TwoSegments::point(k)).norm() < 1e-5);
  }
}

TEST_CASE("a segment that begins after the return to an older one has a number of its own") {
  TwoSegments world;
  CHECK(world.state.segment == 1);
  world.state.enter(0);
  world.state.begin(12);
  CHECK(world.state.segment == 2);
  CHECK(world.state.segment_start == 12);
  CHECK(world.state.posed == 0);
}

TEST_CASE("a keyframe found in another segment waits for others so long and no longer") {
  TwoSegments world;
  BridgeBook book;
  book.add(world.state, 7, world.found(7, 0.0));
  CHECK(book.drop_old(world.state, 11).empty());
  CHECK(book.drop_old(world.state, 40) == std::vector<int32_t>{7});
  CHECK_FALSE(book.hoping());
  book.add(world.state, 8, world.found(8, 0.0));
  world.state.enter(0);
  CHECK(book.drop_old(world.state, 11) == std::vector<int32_t>{8});
}

TEST_CASE("a camera that comes back elsewhere and walks to where it was has one map again") {
  unisim_geometric_config config = default_config();
  config.focal_px = kFocal;
  PredictorRun run(config);
  std::vector<CameraPlace> truth;
  const auto show = [&](const CameraPlace& place, int step) {
    run.show(render_room(place), step % kStride == 0);
    if (step % kStride == 0) truth.push_back(place);
  };
  for (int step = 0; step < 60; ++step) show(walk(step), step);
  const int before = run.keyframes();
  for (int k = 0; k < 30; ++k) run.show(GrayImage(size_t{kWidth} * kHeight, 0), k % kStride == 0);
  const int dark = run.keyframes();
  int held_back = 0;  // keyframes at which no window is given since two segments are being joined
  for (int step = 60; step < 220; ++step) {
    CameraPlace place = walk(step);
    const double aside = std::clamp(1.3 - 0.013 * (step - 110), 0.0, 1.3);
    place.R = place.R * Eigen::AngleAxisd(aside, Eigen::Vector3d::UnitY()).toRotationMatrix();
    show(place, step);
    if (step % kStride == 0 && run.info().joined == 1) {
      held_back += run.window(run.keyframes() - 8, 8).empty() ? 1 : 0;
    }
  }
  CHECK(held_back > 0);
  CHECK(held_back < 10);
  CHECK(run.window(run.keyframes() - 8, 8).size() == 8);
  CHECK(run.info().restarts == 1);
  REQUIRE(run.info().joined == 1);
  REQUIRE(run.table()->finish(run.table()) == UNISIM_PREDICTION_OK);
  // Some of both, of which those right after the dark have no pose.
  std::vector<CameraPlace> both;
  std::vector<unisim_sim3> found;
  for (const int first : {0, dark + 10}) {
    const int truth_first = first == 0 ? 0 : first - (dark - before);
    const std::vector<unisim_sim3> part = run.window(first, 12);
    REQUIRE(part.size() == 12);
    both.insert(both.end(), truth.begin() + truth_first, truth.begin() + truth_first + 12);
    found.insert(found.end(), part.begin(), part.end());
  }
  CHECK(relative_error(found, both) < 0.03);
}

}  // namespace unisim::geometric::test
