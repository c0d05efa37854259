// SPDX-License-Identifier: MIT
// Frames that a predictor has found in its map, in the world of the session.
#include "drivers/pipeline/localiser.hpp"

#include "drivers/pipeline/similarity.hpp"
#include "tests/pipeline/scripted_run.hpp"

namespace unisim::testing {

namespace {

constexpr double kUnit = 0.37;  // of the map, in true units

/// The map of a predictor: the truth in a frame and a unit of its own.
struct Map {
  unisim_predictor table{};  // first: its address is the map's
  std::vector<int64_t> keyframes;
  int32_t other_from = 1000;  ///< keyframes from here on are of another segment

  explicit Map(std::vector<int64_t> frames) : keyframes(std::move(frames)) {
    table.map_pose = [](unisim_predictor* predictor, int32_t id, unisim_map_pose* out) {
      const auto* self = reinterpret_cast<const Map*>(predictor);
      if (id % 7 == 3) return UNISIM_PREDICTION_REJECTED;
      *out = {pose_of(self->keyframes[static_cast<size_t>(id)]), id >= self->other_from ? 1 : 0, 0};
      return UNISIM_PREDICTION_OK;
    };
  }
  static unisim_sim3 pose_of(int64_t frame) {
    const unisim_sim3 T_map_world = {{0.0, 0.6, 0.0, 0.8}, {3.0, -1.0, 2.0}, kUnit};
    unisim_sim3 T = compose(T_map_world, true_pose(frame));
    T.s = 1.0;
    return T;
  }
};

unisim_location found_at(int64_t frame, int32_t keyframe, int32_t segment) {
  unisim_location found{};
  found.T_map_frame = Map::pose_of(frame);
  found.keyframe_id = keyframe;
  found.segment = segment;
  return found;
}

}  // namespace

TEST_CASE("a frame found in the predictor's map lies where it was in the session's world") {
  Run run;
  REQUIRE(run.go().outcome == Outcome::kFinished);
  Map map(run.predictor.keyframes);
  const Localiser localiser(run.pipeline->session(), &map.table);
  for (int64_t frame = 1; frame < 190; frame += 13) {
    unisim_sim3 T{};
    int32_t segment = -1;
    REQUIRE(localiser.pose(found_at(frame, static_cast<int32_t>(frame / 5), 0), &T, &segment));
    INFO(frame);
    CHECK(segment == 0);
    CHECK(Run::distance(T, frame) < 1e-3);
  }
}

TEST_CASE("a frame found in a segment that the session does not know has no pose") {
  Run run;
  REQUIRE(run.go().outcome == Outcome::kFinished);
  Map map(run.predictor.keyframes);
  map.other_from = 20;
  const Localiser localiser(run.pipeline->session(), &map.table);
  unisim_sim3 T{};
  int32_t segment = -1;
  CHECK(localiser.pose(found_at(52, 10, 0), &T, &segment));
  CHECK(localiser.pose(found_at(152, 30, 1), &T, &segment));
  CHECK_FALSE(localiser.pose(found_at(52, 10, 2), &T, &segment));
}

}  // namespace unisim::testing
