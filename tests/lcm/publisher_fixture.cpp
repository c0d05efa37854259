// SPDX-License-Identifier: MIT
// A publisher that writes into a log of its own.
#include "tests/lcm/publisher_fixture.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

namespace unisim::testing {

Made make_publisher(const std::string& url, int32_t unit, int32_t requests) {
  unisim_lcm_publisher_config config{};
  config.struct_size = sizeof config;
  config.unit = unit;
  config.requests = requests;
  config.url = url.c_str();
  Made made;
  char message[512] = "";
  made.publisher.reset(
      unisim_lcm_publisher_create(&config, &made.problem, message, sizeof message));
  made.message = message;
  return made;
}

LoggedPublisher::LoggedPublisher(int32_t unit) {
  Made made = make_publisher("file://" + (folder_ / "out.lcm") + "?mode=w", unit);
  INFO(made.message);
  REQUIRE(made.publisher != nullptr);
  publisher_ = std::move(made.publisher);
}

std::string LoggedPublisher::close() {
  publisher_.reset();
  return folder_ / "out.lcm";
}

unisim_sim3 some_pose() {
  return {{0.0, 0.0, std::sin(0.25), std::cos(0.25)}, {1.0, 2.0, 3.0}, 2.0};
}

unisim_pose some_keyframe(int32_t id) {
  unisim_pose pose{};
  pose.struct_size = sizeof pose;
  pose.keyframe_id = id;
  pose.timestamp_ns = 1000000 * static_cast<int64_t>(id);
  pose.T_world_kf = some_pose();
  pose.state = UNISIM_STATE_TRACKING;
  pose.confidence = 2;
  pose.submap_id = 3;
  return pose;
}

}  // namespace unisim::testing
