// SPDX-License-Identifier: MIT
// Images over the network as frames: the newest wins, waiting can be ended, foreign messages.
#include "drivers/lcm/subscriber.h"

#include <lcm/lcm.h>
#include <unistd.h>

#include <thread>

#include "tests/lcm/image_log.hpp"
#include "tests/lcm/own_network.hpp"
#include "tests/lcm/publisher_fixture.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

struct Subscribed {
  LogSource source;
  int32_t problem = -1;
  std::string message;
};

Subscribed subscribe(const char* url, const char* channel = nullptr) {
  unisim_lcm_subscriber_config config{};
  config.struct_size = sizeof config;
  config.url = url;
  config.channel = channel;
  Subscribed out;
  char message[512] = "";
  out.source.reset(unisim_lcm_subscribe(&config, &out.problem, message, sizeof message));
  out.message = message;
  return out;
}

unisim_lcm_subscriber_counts counts_of(const LogSource& source) {
  unisim_lcm_subscriber_counts counts{};
  counts.struct_size = sizeof counts;
  unisim_lcm_subscriber_get_counts(source.get(), &counts);
  return counts;
}

/// Until so many images and foreign messages have come.
void wait_for(const LogSource& source, int64_t images, int64_t foreign) {
  constexpr int kPatienceMs = 20000;
  for (int k = 0; k < kPatienceMs; ++k) {
    const unisim_lcm_subscriber_counts counts = counts_of(source);
    if (counts.received >= images && counts.foreign >= foreign) return;
    usleep(1000);
  }
  FAIL("messages do not come");
}

void send(const PublisherPtr& publisher, int64_t timestamp_ns, uint8_t brightness) {
  const std::vector<uint8_t> pixels(640 * 480, brightness);
  const unisim_image image = {pixels.data(), 640, 480, 640, UNISIM_PIXEL_GRAY8};
  REQUIRE(unisim_lcm_publish_image(publisher.get(), timestamp_ns, &image) == UNISIM_LCM_QUEUED);
}

}  // namespace

TEST_CASE("images come whole, and of those that wait the newest") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const Subscribed in = subscribe(nullptr);
  INFO(in.message);
  REQUIRE(in.source != nullptr);
  const Made out = make_publisher("");
  REQUIRE(out.publisher != nullptr);
  unisim_frame frame{};
  send(out.publisher, 5000, 10);
  REQUIRE(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_OK);
  CHECK(frame.index == 0);
  CHECK(frame.timestamp_ns == 5000);
  CHECK(frame.image.width == 640);
  CHECK(frame.image.data[640 * 480 - 1] == 10);
  for (int k = 1; k <= 3; ++k) {
    send(out.publisher, 5000 + 1000 * k, static_cast<uint8_t>(10 + k));
    wait_for(in.source, 1 + k, 0);
  }
  REQUIRE(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_OK);
  CHECK(frame.timestamp_ns == 8000);
  CHECK(frame.image.data[0] == 13);
  CHECK(counts_of(in.source).passed_over == 2);
  // A time that does not grow.
  send(out.publisher, 8000, 14);
  CHECK(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_BAD);
  CHECK(has(in.source->message(in.source.get()), "repeats"));
}

TEST_CASE("a message of another type is said once and counted") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const Subscribed in = subscribe(nullptr);
  REQUIRE(in.source != nullptr);
  lcm_t* other = lcm_create(nullptr);
  REQUIRE(other != nullptr);
  for (int k = 0; k < 3; ++k) REQUIRE(lcm_publish(other, "UNISIM_IMAGE", "foreign", 7) == 0);
  wait_for(in.source, 0, 3);
  lcm_destroy(other);
  unisim_frame frame{};
  CHECK(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_BAD);
  CHECK(has(in.source->message(in.source.get()), "no image_t"));
  const Made out = make_publisher("");
  send(out.publisher, 1000, 1);
  CHECK(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_OK);
}

TEST_CASE("an interrupt ends the wait for an image, from another thread and for good") {
  UNISIM_SKIP_WITHOUT_NETWORK();
  const Subscribed in = subscribe(nullptr);
  REQUIRE(in.source != nullptr);
  std::thread other([&] { in.source->interrupt(in.source.get()); });
  unisim_frame frame{};
  CHECK(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_END);
  other.join();
  CHECK(in.source->next_frame(in.source.get(), 1, &frame) == UNISIM_FRAME_END);
}

TEST_CASE("what cannot be listened to is refused") {
  CHECK(has(subscribe("file:///tmp/run.lcm").message, "--format lcm"));
  CHECK(subscribe("nonsense").problem == UNISIM_LCM_BAD_CONFIG);
  CHECK(has(subscribe("", "CAMERA.*").message, "CAMERA.*"));
}
