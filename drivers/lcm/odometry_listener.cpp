// SPDX-License-Identifier: MIT
// Poses of an odometer that come over LCM.
#include "drivers/lcm/odometry_listener.hpp"

#include <atomic>
#include <cmath>
#include <new>
#include <thread>

#include "drivers/lcm/error.hpp"
#include "drivers/lcm/network.hpp"
#include "unisim_pose_t.h"

namespace unisim::lcm {
namespace {

// Longer than that no tracking takes for a keyframe.
constexpr int kWaiting = 4096;

LcmPtr open(const OdometryListenerConfig& config) {
  check_channel(config.channel);
  return open_network(parse_url(config.url.c_str(), Direction::kSubscribe));
}

bool usable(const unisim_pose_t& pose) {
  return pose.utime <= kLastMicrosecond && pose.utime >= -kLastMicrosecond &&
         std::isfinite(pose.pos[0]) && std::isfinite(pose.pos[1]) && std::isfinite(pose.pos[2]);
}

}  // namespace

class OdometryListener::Impl {
 public:
  Impl(const OdometryListenerConfig& config, pipeline::DistanceInbox* inbox)
      : common_sigma_(config.common_sigma), inbox_(inbox), network_(open(config)) {
    lcm_subscription_t* const subscription =
        lcm_subscribe(network_.get(), config.channel.c_str(), on_message, this);
    lcm_subscription_set_queue_capacity(subscription, kWaiting);
    thread_ = std::thread([this] { listen(); });
  }
  ~Impl() {
    ending_ = true;
    thread_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  OdometryCounts counts() const { return {taken_, foreign_, refused_}; }

 private:
  static void on_message(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
    static_cast<Impl*>(user)->take(*received);
  }

  void take(const lcm_recv_buf_t& received) {
    const auto size = static_cast<int>(received.data_size);
    unisim_pose_t pose{};
    if (unisim_pose_t_decode(received.data, 0, size, &pose) < 0 || !usable(pose)) {
      ++foreign_;
      return;
    }
    const pipeline::OdometryPosition position = {1000 * pose.utime,
                                                 {pose.pos[0], pose.pos[1], pose.pos[2]}};
    // The caller is LCM, which is C: nothing may be thrown through it.
    try {
      ++(inbox_->add(position, common_sigma_) ? taken_ : refused_);
    } catch (const std::bad_alloc&) {
      ++refused_;
    }
  }

  void listen() {
    while (!ending_ && lcm_handle_timeout(network_.get(), kSliceMs) >= 0) continue;
  }

  double common_sigma_;
  pipeline::DistanceInbox* inbox_;
  LcmPtr network_;
  std::thread thread_;
  std::atomic<bool> ending_{false};
  std::atomic<int64_t> taken_{0};
  std::atomic<int64_t> foreign_{0};
  std::atomic<int64_t> refused_{0};
};

OdometryListener::OdometryListener(const OdometryListenerConfig& config,
                                   pipeline::DistanceInbox* inbox)
    : impl_(std::make_unique<Impl>(config, inbox)) {}

OdometryListener::~OdometryListener() = default;

OdometryCounts OdometryListener::counts() const { return impl_->counts(); }

}  // namespace unisim::lcm
