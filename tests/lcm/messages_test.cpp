// SPDX-License-Identifier: MIT
// What is on the wire: bytes of bot_core, limits of size, what is refused.
#include <cmath>
#include <limits>
#include <vector>

#include "tests/lcm/decoded.hpp"
#include "tests/lcm/event_log.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/support/catch.hpp"
#include "unisim_correction_t.h"
#include "unisim_image_t.h"
#include "unisim_keyframe_t.h"
#include "unisim_points_t.h"
#include "unisim_status_t.h"
#include "unisim_trajectory_t.h"

using namespace unisim::testing;

namespace {

// Receivers with Linux's usual buffers, and one datagram of UDP.
constexpr size_t kLargest = 60000;

/// The fingerprint of a type as the specification of LCM has it: names, types and dimensions of the
/// fields, not the name of the type or its package.
class Fingerprint {
 public:
  Fingerprint& field(const std::string& name, const std::string& type,
                     const std::vector<std::string>& sizes = {}) {
    add(name);
    if (!type.empty()) add(type);
    add(static_cast<char>(sizes.size()));
    for (const std::string& size : sizes) {
      const bool variable = size.find_first_not_of("0123456789") != std::string::npos;
      add(static_cast<char>(variable ? 1 : 0));
      add(size);
    }
    return *this;
  }

  /// @param nested fingerprints of the types of fields that are types themselves
  uint64_t value(uint64_t nested = 0) const {
    const uint64_t sum = static_cast<uint64_t>(hash_) + nested;
    return (sum << 1) + (sum >> 63);
  }

 private:
  void add(char byte) {
    hash_ = static_cast<int64_t>((static_cast<uint64_t>(hash_) << 8) ^
                                 static_cast<uint64_t>(hash_ >> 55)) +
            byte;
  }
  void add(const std::string& text) {
    add(static_cast<char>(text.size()));
    for (const char byte : text) add(byte);
  }

  int64_t hash_ = 0x12345678;
};

uint64_t pose_fingerprint() {
  return Fingerprint()
      .field("utime", "int64_t")
      .field("pos", "double", {"3"})
      .field("vel", "double", {"3"})
      .field("orientation", "double", {"4"})
      .field("rotation_rate", "double", {"3"})
      .field("accel", "double", {"3"})
      .value();
}

uint64_t image_fingerprint() {
  const uint64_t metadata = Fingerprint()
                                .field("key", "string")
                                .field("n", "int32_t")
                                .field("value", "byte", {"n"})
                                .value();
  return Fingerprint()
      .field("utime", "int64_t")
      .field("width", "int32_t")
      .field("height", "int32_t")
      .field("row_stride", "int32_t")
      .field("pixelformat", "int32_t")
      .field("size", "int32_t")
      .field("data", "byte", {"size"})
      .field("nmetadata", "int32_t")
      .field("metadata", "", {"nmetadata"})
      .value(metadata);
}

}  // namespace

TEST_CASE("a pose is bot_core.pose_t byte for byte") {
  LoggedPublisher out;
  const unisim_sim3 T = some_pose();
  REQUIRE(unisim_lcm_publish_pose(out.get(), 1234567999, &T) == UNISIM_LCM_QUEUED);
  std::string golden = big_endian(pose_fingerprint(), 8) + wire(int64_t{1234567});
  for (const double value : {1.0, 2.0, 3.0}) golden += wire(value);
  for (int k = 0; k < 3; ++k) golden += wire(0.0);
  for (const double value : {std::cos(0.25), 0.0, 0.0, std::sin(0.25)}) golden += wire(value);
  for (int k = 0; k < 6; ++k) golden += wire(0.0);
  const std::vector<std::string> sent = messages_on("UNISIM_POSE", out.close());
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].size() == 8 + 8 + 16 * 8);
  CHECK(sent[0] == golden);
}

TEST_CASE("the fingerprint of bot_core.pose_t is the one its users have") {
  // As lcm-gen 1.3.1 and 1.5.3 make it of bot_core.pose_t.
  CHECK(pose_fingerprint() == 0x2e16efb052b0105eULL);
}

TEST_CASE("an image is bot_core.image_t byte for byte") {
  LoggedPublisher out;
  const std::vector<uint8_t> pixels = {1, 2, 3, 4, 5, 6};
  const unisim_image image = {pixels.data(), 3, 2, 3, UNISIM_PIXEL_GRAY8};
  REQUIRE(unisim_lcm_publish_image(out.get(), 5000, &image) == UNISIM_LCM_QUEUED);
  const std::string golden = big_endian(image_fingerprint(), 8) + wire(int64_t{5}) + wire(3) +
                             wire(2) + wire(3) + "GREY" + wire(6) + "\1\2\3\4\5\6" + wire(0);
  std::string fourcc_turned = golden;
  fourcc_turned.replace(28, 4, "YERG");
  const std::vector<std::string> sent = messages_on("UNISIM_IMAGE", out.close());
  REQUIRE(sent.size() == 1);
  CHECK(sent[0] == fourcc_turned);
}

TEST_CASE("the unit that is sent may become known on the way") {
  LoggedPublisher out;
  const unisim_pose pose = some_keyframe(7);
  REQUIRE(unisim_lcm_publish_keyframe(out.get(), &pose, 4, nullptr) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publisher_set_unit(out.get(), UNISIM_LCM_UNIT_METRIC, 0.02) ==
          UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_keyframe(out.get(), &pose, 4, nullptr) == UNISIM_LCM_QUEUED);
  CHECK(unisim_lcm_publisher_set_unit(out.get(), 7, 0.0) == UNISIM_LCM_REFUSED);
  CHECK(unisim_lcm_publisher_set_unit(nullptr, UNISIM_LCM_UNIT_METRIC, 0.0) == UNISIM_LCM_REFUSED);
  CHECK(unisim_lcm_publisher_set_unit(out.get(), UNISIM_LCM_UNIT_METRIC,
                                      std::numeric_limits<double>::quiet_NaN()) ==
        UNISIM_LCM_REFUSED);
  const std::vector<std::string> sent = messages_on("UNISIM_KEYFRAME", out.close());
  REQUIRE(sent.size() == 2);
  CHECK(decoded(sent[0], unisim_keyframe_t_decode).unit == UNISIM_STATUS_T_UNIT_RELATIVE);
  CHECK(decoded(sent[0], unisim_keyframe_t_decode).scale_sigma == 0.0);
  CHECK(decoded(sent[1], unisim_keyframe_t_decode).unit == UNISIM_STATUS_T_UNIT_METRIC);
  CHECK(decoded(sent[1], unisim_keyframe_t_decode).scale_sigma == 0.02);
}

TEST_CASE("a keyframe says its unit, revision and variances") {
  LoggedPublisher out(UNISIM_LCM_UNIT_METRIC);
  const unisim_pose pose = some_keyframe(7);
  double covariance[49] = {};
  for (int k = 0; k < 7; ++k) covariance[8 * k] = k + 0.5;
  REQUIRE(unisim_lcm_publish_keyframe(out.get(), &pose, 4, nullptr) == UNISIM_LCM_QUEUED);
  REQUIRE(unisim_lcm_publish_keyframe(out.get(), &pose, 5, covariance) == UNISIM_LCM_QUEUED);
  const std::vector<std::string> sent = messages_on("UNISIM_KEYFRAME", out.close());
  REQUIRE(sent.size() == 2);
  const auto early = decoded(sent[0], unisim_keyframe_t_decode);
  CHECK(early.utime == 7000);
  CHECK(early.map_revision == 4);
  CHECK(early.covariance[0] == -1.0);
  const auto late = decoded(sent[1], unisim_keyframe_t_decode);
  CHECK(late.id == 7);
  CHECK(late.map_revision == 5);
  CHECK(late.pos[2] == 3.0);
  CHECK(late.scale == 2.0);
  CHECK(late.covariance[6] == 6.5);
  CHECK(late.confidence == 2);
  CHECK(late.submap == 3);
  CHECK(late.unit == UNISIM_STATUS_T_UNIT_METRIC);
}

TEST_CASE("a correction carries the jump and what has changed") {
  LoggedPublisher out;
  unisim_lcm_correction correction{};
  correction.struct_size = sizeof correction;
  correction.map_revision = 3;
  correction.timestamp_ns = 9000;
  correction.keyframe_id = 12;
  correction.first_changed = 2;
  correction.last_changed = 12;
  correction.T_new_old = some_pose();
  REQUIRE(unisim_lcm_publish_correction(out.get(), &correction) == UNISIM_LCM_QUEUED);
  const std::vector<std::string> sent = messages_on("UNISIM_CORRECTION", out.close());
  REQUIRE(sent.size() == 1);
  const auto read = decoded(sent[0], unisim_correction_t_decode);
  CHECK(read.utime == 9);
  CHECK(read.map_revision == 3);
  CHECK(read.keyframe == 12);
  CHECK(read.first_changed == 2);
  CHECK(read.last_changed == 12);
  CHECK(read.jump_scale == 2.0);
  CHECK(read.jump_orientation[0] == std::cos(0.25));
  CHECK(read.jump_pos[0] == 1.0);
}

TEST_CASE("a status carries the stages") {
  LoggedPublisher out;
  const unisim_lcm_stage stages[] = {{"decode", 5, 1.0, 2.0, 3.0}, {"observe", 6, 4.0, 5.0, 6.0}};
  unisim_lcm_status status{};
  status.struct_size = sizeof status;
  status.state = UNISIM_STATE_LOST;
  status.reason = UNISIM_STATUS_T_REASON_COVERED;
  status.queue_depth = 4;
  status.stage_count = 2;
  status.stages = stages;
  REQUIRE(unisim_lcm_publish_status(out.get(), &status) == UNISIM_LCM_QUEUED);
  status.struct_size = offsetof(unisim_lcm_status, reason);  // of a program that knows no reasons
  REQUIRE(unisim_lcm_publish_status(out.get(), &status) == UNISIM_LCM_QUEUED);
  status.struct_size -= 8;
  REQUIRE(unisim_lcm_publish_status(out.get(), &status) == UNISIM_LCM_REFUSED);
  const std::vector<std::string> sent = messages_on("UNISIM_STATUS", out.close());
  REQUIRE(sent.size() == 2);
  auto older = decoded(sent[1], unisim_status_t_decode);
  CHECK(older.reason == UNISIM_STATUS_T_REASON_NONE);
  unisim_status_t_decode_cleanup(&older);
  auto read = decoded(sent[0], unisim_status_t_decode);
  CHECK(read.state == UNISIM_STATUS_T_STATE_LOST);
  CHECK(read.reason == UNISIM_STATUS_T_REASON_COVERED);
  CHECK(read.queue_depth == 4);
  REQUIRE(read.n == 2);
  CHECK(std::string(read.stages[1].name) == "observe");
  CHECK(read.stages[1].p95_ms == 5.0);
  unisim_status_t_decode_cleanup(&read);
}

TEST_CASE("trajectories and points go in messages under 60 kB") {
  LoggedPublisher out;
  std::vector<unisim_pose> poses;
  for (int32_t id = 0; id < UNISIM_LCM_CHUNK_POSES; ++id) poses.push_back(some_keyframe(id));
  REQUIRE(unisim_lcm_publish_trajectory(out.get(), 0, 1, poses.data(), UNISIM_LCM_CHUNK_POSES, 0,
                                        1) == UNISIM_LCM_QUEUED);
  std::vector<float> xyz;
  for (int k = 0; k < 3 * 10000; ++k) xyz.push_back(static_cast<float>(k));
  unisim_lcm_points points{};
  points.struct_size = sizeof points;
  points.T_world_points = some_pose();
  points.xyz = xyz.data();
  points.count = 10000;
  REQUIRE(unisim_lcm_publish_points(out.get(), &points) == UNISIM_LCM_QUEUED);
  const std::string log = out.close();
  for (const LogEvent& event : read_log(log)) CHECK(event.data.size() < kLargest);

  const std::vector<std::string> trajectory = messages_on("UNISIM_TRAJECTORY", log);
  REQUIRE(trajectory.size() == 1);
  auto read = decoded(trajectory[0], unisim_trajectory_t_decode);
  REQUIRE(read.n == UNISIM_LCM_CHUNK_POSES);
  CHECK(read.poses[511].id == 511);
  CHECK(read.poses[511].orientation[3] == std::sin(0.25));
  unisim_trajectory_t_decode_cleanup(&read);

  const std::vector<std::string> cloud = messages_on("UNISIM_POINTS", log);
  REQUIRE(cloud.size() == 3);
  float next = 0.0F;
  for (size_t k = 0; k < cloud.size(); ++k) {
    auto part = decoded(cloud[k], unisim_points_t_decode);
    CHECK(part.chunk == static_cast<int>(k));
    CHECK(part.chunks == 3);
    for (int i = 0; i < part.n; ++i) REQUIRE(part.xyz[i] == next++);
    unisim_points_t_decode_cleanup(&part);
  }
  CHECK(next == 30000.0F);
}

TEST_CASE("what makes no sense is refused and nothing is sent") {
  LoggedPublisher out;
  unisim_sim3 T = some_pose();
  T.t[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(unisim_lcm_publish_pose(out.get(), 0, &T) == UNISIM_LCM_REFUSED);
  T = some_pose();
  T.s = 0.0;
  CHECK(unisim_lcm_publish_pose(out.get(), 0, &T) == UNISIM_LCM_REFUSED);
  CHECK(unisim_lcm_publish_pose(out.get(), 0, nullptr) == UNISIM_LCM_REFUSED);
  CHECK(unisim_lcm_publish_pose(nullptr, 0, &T) == UNISIM_LCM_REFUSED);
  const unisim_pose pose = some_keyframe(0);
  CHECK(unisim_lcm_publish_trajectory(out.get(), 0, 0, &pose, 1, 1, 1) == UNISIM_LCM_REFUSED);
  CHECK(unisim_lcm_publish_trajectory(out.get(), 0, 0, &pose, UNISIM_LCM_CHUNK_POSES + 1, 0, 1) ==
        UNISIM_LCM_REFUSED);
  unisim_lcm_status status{};
  status.struct_size = sizeof status;
  status.stage_count = 1;
  CHECK(unisim_lcm_publish_status(out.get(), &status) == UNISIM_LCM_REFUSED);
  const std::vector<uint8_t> pixels(4 << 20);
  const unisim_image image = {pixels.data(), 2048, 2048, 2048, UNISIM_PIXEL_GRAY8};
  CHECK(unisim_lcm_publish_image(out.get(), 0, &image) == UNISIM_LCM_TOO_BIG);
  CHECK(read_log(out.close()).empty());
}
