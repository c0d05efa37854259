// SPDX-License-Identifier: MIT
// Life of a publisher, requests and counters.
#include "drivers/lcm/publisher.h"

#include <poll.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "drivers/common/copy_out.hpp"
#include "drivers/lcm/error.hpp"
#include "drivers/lcm/publisher_state.hpp"
#include "unisim_request_t.h"

namespace unisim::lcm {
namespace {

constexpr int32_t kUsualQueueBytes = 4 << 20;
// Half of it holds the largest message that is not an image.
constexpr int32_t kLeastQueueBytes = 2 * 64 * 1024;
constexpr int32_t kMostQueueBytes = 1 << 30;

void on_request(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
  auto* publisher = static_cast<unisim_lcm_publisher*>(user);
  unisim_request_t request{};
  const int size = static_cast<int>(received->data_size);
  if (unisim_request_t_decode(received->data, 0, size, &request) < 0 ||
      request.what != UNISIM_REQUEST_T_TRAJECTORY) {
    ++publisher->foreign;
    return;
  }
  // Of two requests that wait the one that wants more answers both.
  const int32_t first = std::max(request.first_id, 0);
  publisher->wanted_id = publisher->wanted_id < 0 ? first : std::min(publisher->wanted_id, first);
}

unisim_lcm_publisher_config copy_config(const unisim_lcm_publisher_config* given) {
  unisim_lcm_publisher_config config{};
  const auto refuse = [](const std::string& line) { throw LcmError(UNISIM_LCM_BAD_CONFIG, line); };
  if (given != nullptr) {
    if (given->struct_size < sizeof config) {
      refuse("unisim_lcm_publisher_config: set struct_size to its sizeof");
    }
    std::memcpy(&config, given, sizeof config);
  }
  if (config.unit != UNISIM_LCM_UNIT_RELATIVE && config.unit != UNISIM_LCM_UNIT_METRIC) {
    refuse("unit " + std::to_string(config.unit) + " is not known: give UNISIM_LCM_UNIT_*");
  }
  if (config.queue_bytes == 0) config.queue_bytes = kUsualQueueBytes;
  if (config.queue_bytes < kLeastQueueBytes || config.queue_bytes > kMostQueueBytes) {
    refuse("queue_bytes is " + std::to_string(config.queue_bytes) + ": give " +
           std::to_string(kLeastQueueBytes) + " to " + std::to_string(kMostQueueBytes));
  }
  return config;
}

unisim_lcm_publisher* make(const unisim_lcm_publisher_config& config) {
  const Url url = parse_url(config.url, Direction::kPublish);
  auto publisher = std::make_unique<unisim_lcm_publisher>();
  publisher->unit = config.unit;
  publisher->network = open_network(url);
  if (config.requests != 0 && url.provider != "file") {
    publisher->requests =
        lcm_subscribe(publisher->network.get(), "UNISIM_REQUEST", on_request, publisher.get());
  }
  const auto send = [network = publisher->network](const char* channel, const void* bytes,
                                                   size_t size) {
    return lcm_publish(network.get(), channel, bytes, static_cast<unsigned>(size));
  };
  publisher->queue = std::make_unique<SendQueue>(static_cast<size_t>(config.queue_bytes), send);
  return publisher.release();
}

}  // namespace
}  // namespace unisim::lcm

unisim_lcm_publisher* unisim_lcm_publisher_create(const unisim_lcm_publisher_config* config,
                                                  int32_t* problem, char* message,
                                                  size_t capacity) {
  return unisim::lcm::create(problem, message, capacity,
                             [&] { return unisim::lcm::make(unisim::lcm::copy_config(config)); });
}

void unisim_lcm_publisher_destroy(unisim_lcm_publisher* publisher) {
  if (publisher == nullptr) return;
  if (publisher->requests != nullptr) {
    lcm_unsubscribe(publisher->network.get(), publisher->requests);
  }
  delete publisher;
}

void unisim_lcm_publisher_flush(unisim_lcm_publisher* publisher) { publisher->queue->flush(); }

int unisim_lcm_next_request(unisim_lcm_publisher* publisher, int32_t* first_id) {
  if (publisher->requests == nullptr) return 0;
  pollfd waiting = {lcm_get_fileno(publisher->network.get()), POLLIN, 0};
  while (poll(&waiting, 1, 0) > 0 && lcm_handle(publisher->network.get()) == 0) {
  }
  if (publisher->wanted_id < 0) return 0;
  *first_id = publisher->wanted_id;
  publisher->wanted_id = -1;
  return 1;
}

void unisim_lcm_publisher_get_counts(const unisim_lcm_publisher* publisher,
                                     unisim_lcm_publisher_counts* counts) {
  const unisim::lcm::SendCounts sent = publisher->queue->counts();
  const unisim_lcm_publisher_counts all = {
      0, sent.error_number, sent.queued, sent.sent, sent.dropped, sent.failed, publisher->foreign};
  unisim::drivers::copy_out(all, counts);
}
