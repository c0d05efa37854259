// SPDX-License-Identifier: MIT
// Once a publisher is made, its messages take no memory from the heap.
#include <unistd.h>

#include <vector>

#include "tests/alloc/malloc_counter.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::testing;

namespace {

/// One message of each kind.
int publish_all(unisim_lcm_publisher* publisher, int k, const std::vector<unisim_pose>& poses,
                const unisim_lcm_points& points, const unisim_image& image) {
  unisim_lcm_correction correction{};
  correction.struct_size = sizeof correction;
  correction.T_new_old = some_pose();
  const unisim_lcm_stage stage = {"decode", 5, 1.0, 2.0, 3.0};
  unisim_lcm_status status{};
  status.struct_size = sizeof status;
  status.stage_count = 1;
  status.stages = &stage;
  int refused = unisim_lcm_publish_pose(publisher, k, &points.T_world_points);
  refused += unisim_lcm_publish_keyframe(publisher, poses.data(), 0, nullptr);
  refused += unisim_lcm_publish_correction(publisher, &correction);
  refused += unisim_lcm_publish_status(publisher, &status);
  refused += unisim_lcm_publish_trajectory(publisher, k, 0, poses.data(),
                                           static_cast<int32_t>(poses.size()), 0, 1);
  refused += unisim_lcm_publish_points(publisher, &points);
  refused += unisim_lcm_publish_image(publisher, k, &image);
  return refused;
}

int64_t gone(const unisim_lcm_publisher* publisher) {
  unisim_lcm_publisher_counts counts{};
  counts.struct_size = sizeof counts;
  unisim_lcm_publisher_get_counts(publisher, &counts);
  return counts.sent + counts.failed + counts.dropped;
}

}  // namespace

TEST_CASE("a hundred messages of each kind over the network make no heap call") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const Made made = make_publisher("");
  INFO(made.message);
  REQUIRE(made.publisher != nullptr);
  std::vector<unisim_pose> poses;
  for (int32_t id = 0; id < UNISIM_LCM_CHUNK_POSES; ++id) poses.push_back(some_keyframe(id));
  const std::vector<float> xyz(3 * 1000);
  unisim_lcm_points points{};
  points.struct_size = sizeof points;
  points.T_world_points = some_pose();
  points.xyz = xyz.data();
  points.count = 1000;
  const std::vector<uint8_t> pixels(640 * 480);
  const unisim_image image = {pixels.data(), 640, 480, 640, UNISIM_PIXEL_GRAY8};
  // The thread that sends takes memory of its own when it starts.
  REQUIRE(unisim_lcm_publish_pose(made.publisher.get(), 0, &points.T_world_points) ==
          UNISIM_LCM_QUEUED);
  while (gone(made.publisher.get()) < 1) usleep(1000);
  const int64_t before = unisim::test::heap_calls();
  int refused = 0;
  for (int k = 0; k < 100; ++k)
    refused += publish_all(made.publisher.get(), k, poses, points, image);
  while (gone(made.publisher.get()) < 701) usleep(1000);
  const int64_t calls = unisim::test::heap_calls() - before;
  CHECK(calls == 0);
  CHECK(refused == 0);
}
