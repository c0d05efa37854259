// SPDX-License-Identifier: MIT
// Programs built against an older or a newer header: the struct_size rules.
#include <cstddef>
#include <cstring>
#include <vector>

#include "tests/capi/world.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::test;

namespace {

/// A struct as a newer header would have it: 16 bytes longer.
template <class T>
struct Newer {
  T known;
  unsigned char tail[16];
};

template <class T>
Newer<T> newer(const T& known) {
  Newer<T> longer = {};
  longer.known = known;
  longer.known.struct_size = sizeof longer;
  return longer;
}

}  // namespace

TEST_CASE("a config of a newer header passes while its unknown tail is zero") {
  Newer<unisim_config> config = newer(default_config());
  size_t size = 0;
  CHECK(unisim_arena_size(&config.known, &size) == UNISIM_OK);
  config.tail[7] = 1;
  CHECK(unisim_arena_size(&config.known, &size) == UNISIM_ERR_ABI_MISMATCH);
}

TEST_CASE("a config of the first release takes defaults for what came later") {
  unisim_config config = default_config();
  size_t today = 0;
  REQUIRE(unisim_arena_size(&config, &today) == UNISIM_OK);
  config.struct_size = offsetof(unisim_config, loop_gate);
  config.loop_gate = -1.0;
  size_t size = 0;
  CHECK(unisim_arena_size(&config, &size) == UNISIM_OK);
  CHECK(size == today);
}

TEST_CASE("unisim_config_init fills a newer struct's tail with zeros") {
  Newer<unisim_config> config;
  std::memset(&config, 0xFF, sizeof config);
  REQUIRE(unisim_config_init(&config.known, sizeof config) == UNISIM_OK);
  CHECK(config.known.struct_size == sizeof config);
  for (const unsigned char byte : config.tail) CHECK(byte == 0);
}

TEST_CASE("structs smaller than the first release are refused") {
  unisim_config config = default_config();
  size_t size = 0;
  CHECK(unisim_config_init(&config, 8) == UNISIM_ERR_ABI_MISMATCH);
  config.struct_size = offsetof(unisim_config, skeleton_capacity);
  CHECK(unisim_arena_size(&config, &size) == UNISIM_ERR_ABI_MISMATCH);
  Host host(default_config());
  unisim_keyframe keyframe = {8, 0, 0};
  int32_t id = 0;
  CHECK(unisim_add_keyframe(host, &keyframe, &id) == UNISIM_ERR_ABI_MISMATCH);
  unisim_session_info info = {};
  CHECK(unisim_get_info(host, &info) == UNISIM_ERR_ABI_MISMATCH);
  unisim_pose pose = {};
  CHECK(unisim_get_pose(host, 0, &pose) == UNISIM_ERR_ABI_MISMATCH);
  unisim_report report = {};
  CHECK(unisim_optimize(host, nullptr, &report) == UNISIM_ERR_ABI_MISMATCH);
  unisim_budget budget = {4, 1};
  CHECK(unisim_optimize(host, &budget, nullptr) == UNISIM_ERR_ABI_MISMATCH);
}

TEST_CASE("results of a newer struct have zeros in its tail and keep its size") {
  World world(4, 1U);
  Host host(default_config());
  host.feed(world, 4);
  unisim_pose plain = {};
  plain.struct_size = sizeof plain;
  Newer<unisim_pose> pose = newer(plain);
  std::memset(pose.tail, 0x5A, sizeof pose.tail);
  REQUIRE(unisim_get_pose(host, 2, &pose.known) == UNISIM_OK);
  CHECK(pose.known.struct_size == sizeof pose);
  CHECK(pose.known.keyframe_id == 2);
  for (const unsigned char byte : pose.tail) CHECK(byte == 0);
}

TEST_CASE("a size that no header will ever have is refused") {
  Host host(default_config());
  unisim_session_info info = {};
  info.struct_size = UINT32_MAX;  // as in memory nobody has set
  CHECK(unisim_get_info(host, &info) == UNISIM_ERR_ABI_MISMATCH);
  unisim_keyframe keyframe = {UINT32_MAX, 0, 0};
  int32_t id = 0;
  CHECK(unisim_add_keyframe(host, &keyframe, &id) == UNISIM_ERR_ABI_MISMATCH);
  unisim_config config;
  CHECK(unisim_config_init(&config, UINT32_MAX) == UNISIM_ERR_ABI_MISMATCH);
}

TEST_CASE("a trajectory is written with the caller's stride") {
  World world(4, 1U);
  Host host(default_config());
  host.feed(world, 4);
  std::vector<Newer<unisim_pose>> poses(4);
  for (Newer<unisim_pose>& pose : poses) std::memset(&pose, 0x5A, sizeof pose);
  poses[0].known.struct_size = sizeof poses[0];
  size_t count = 0;
  CHECK(unisim_get_trajectory(host, &poses[0].known, 3, &count) == UNISIM_ERR_CAPACITY);
  CHECK(count == 4);
  REQUIRE(unisim_get_trajectory(host, &poses[0].known, 4, &count) == UNISIM_OK);
  for (int32_t k = 0; k < 4; ++k) {
    CHECK(poses[static_cast<size_t>(k)].known.keyframe_id == k);
    CHECK(poses[static_cast<size_t>(k)].known.timestamp_ns == 1000 * k);
    for (const unsigned char byte : poses[static_cast<size_t>(k)].tail) CHECK(byte == 0);
  }
  CHECK(unisim_get_trajectory(host, nullptr, 0, &count) == UNISIM_ERR_CAPACITY);
  CHECK(count == 4);
}

TEST_CASE("the library says the version of its header") {
  CHECK(unisim_version() == UNISIM_VERSION_NUMBER);
  CHECK(std::string(unisim_status_string(UNISIM_ERR_CAPACITY)) == "capacity exceeded");
  CHECK(unisim_status_string(-5) != nullptr);
}
