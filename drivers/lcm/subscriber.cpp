// SPDX-License-Identifier: MIT
// Images over LCM as a source of frames: a thread listens and keeps the newest.
#include "drivers/lcm/subscriber.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/common/copy_out.hpp"
#include "drivers/lcm/error.hpp"
#include "drivers/lcm/network.hpp"
#include "drivers/sequence/frame_source.hpp"
#include "drivers/sequence/lcm_image.hpp"

namespace unisim::lcm {
namespace {

using sequence::ImageMessage;

// Holds a colour image of 1280x720 whole, which arrives faster than it is read.
constexpr int64_t kReceiveBytes = 4 << 20;

class Subscriber final : public sequence::FrameSource {
 public:
  Subscriber(LcmPtr network, std::string channel, std::vector<std::string> notes)
      : FrameSource("lcm", {}, std::move(notes), {}),
        channel_(std::move(channel)),
        network_(std::move(network)) {
    interrupt = [](unisim_source* source) { static_cast<Subscriber*>(source)->stop_waiting(); };
    lcm_subscribe(network_.get(), channel_.c_str(), on_message, this);
    thread_ = std::thread([this] { listen(); });
  }
  ~Subscriber() override {
    ending_ = true;
    thread_.join();
  }
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  unisim_lcm_subscriber_counts counts() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {sizeof(unisim_lcm_subscriber_counts), 0, received_, passed_over_, foreign_};
  }

 private:
  static void on_message(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
    static_cast<Subscriber*>(user)->take(static_cast<const uint8_t*>(received->data),
                                         received->data_size);
  }

  void take(const uint8_t* bytes, size_t size) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (sequence::is_image_message(bytes, size)) {
        keep(bytes, size);
      } else {
        ++foreign_;
      }
    }
    changed_.notify_all();
  }

  /// The caller is LCM, which is C: nothing may be thrown through it.
  void keep(const uint8_t* bytes, size_t size) {
    ++received_;
    passed_over_ += fresh_ ? 1 : 0;
    fresh_ = false;
    try {
      newest_.assign(bytes, bytes + size);
      fresh_ = true;
    } catch (const std::bad_alloc&) {
      ++passed_over_;
    }
  }

  void listen() {
    while (!ending_) {
      if (lcm_handle_timeout(network_.get(), kSliceMs) >= 0) continue;
      const std::lock_guard<std::mutex> lock(mutex_);
      broken_ = true;
      changed_.notify_all();
      return;
    }
  }

  void stop_waiting() {
    const std::lock_guard<std::mutex> lock(mutex_);
    interrupted_ = true;
    changed_.notify_all();
  }

  const std::string& frame_path() const override { return channel_; }
  int64_t count() const override { return -1; }

  int read(int decode, unisim_frame* frame) override {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto foreign_is_news = [this] { return foreign_ > 0 && !foreign_said_; };
    changed_.wait(lock, [&] { return fresh_ || interrupted_ || broken_ || foreign_is_news(); });
    if (interrupted_) return UNISIM_FRAME_END;
    if (foreign_is_news()) {
      foreign_said_ = true;
      return answer(UNISIM_FRAME_BAD, "lcm: a message on channel '" + channel_ +
                                          "' is no image_t (its fingerprint is another): such are "
                                          "passed over");
    }
    if (!fresh_) return answer(UNISIM_FRAME_FAILED, "lcm: channel '" + channel_ + "': LCM stopped");
    std::swap(newest_, current_);
    fresh_ = false;
    lock.unlock();
    return give(decode != 0, frame);
  }

  int give(bool decode_image, unisim_frame* frame) {
    frame->index = next_index_++;
    const std::string name = "image on channel '" + channel_ + "'";
    std::string reason;
    ImageMessage sent{};
    bool good = sequence::parse_image_message(current_.data(), current_.size(), &sent, &reason);
    if (good && (sent.utime > kLastMicrosecond || sent.utime < -kLastMicrosecond)) {
      good = false;
      reason = "has a time out of range";
    }
    if (good) {
      frame->timestamp_ns = 1000 * sent.utime;
      if (!in_time_order(frame->index, frame->timestamp_ns, name)) return UNISIM_FRAME_BAD;
      good = !decode_image || decoder_.decode(sent, &frame->image, &reason);
    }
    if (good) return UNISIM_FRAME_OK;
    return answer(UNISIM_FRAME_BAD, "frame " + std::to_string(frame->index) + ": " + name + " " +
                                        reason + ": skipped");
  }

  std::string channel_;
  LcmPtr network_;
  std::thread thread_;
  std::atomic<bool> ending_{false};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<uint8_t> newest_;   // of the thread
  std::vector<uint8_t> current_;  // of the caller
  bool fresh_ = false;
  bool interrupted_ = false;
  bool broken_ = false;
  bool foreign_said_ = false;
  int64_t received_ = 0;
  int64_t passed_over_ = 0;
  int64_t foreign_ = 0;
  int64_t next_index_ = 0;
  sequence::MessageDecoder decoder_;
};

/// Asks for room, and says where the system does not give it.
void ask_for_room(Url* url, std::vector<std::string>* notes) {
  if (url->provider != "udpm") return;
  if (url->receive_bytes == 0) {
    url->receive_bytes = kReceiveBytes;
    url->text += (url->text.find('?') == std::string::npos ? "?" : "&") +
                 std::string("recv_buf_size=") + std::to_string(kReceiveBytes);
  }
  const int64_t most = receive_limits().most;
  if (most <= 0 || most >= url->receive_bytes) return;
  notes->push_back("lcm: the system gives a receive buffer of " + std::to_string(most) +
                   " bytes, larger images are lost: sysctl -w net.core.rmem_max=" +
                   std::to_string(url->receive_bytes));
}

unisim_source* make(const unisim_lcm_subscriber_config* given) {
  unisim_lcm_subscriber_config config{};
  if (given != nullptr) {
    if (given->struct_size < sizeof config) {
      throw LcmError(UNISIM_LCM_BAD_CONFIG,
                     "unisim_lcm_subscriber_config: set struct_size to its sizeof");
    }
    std::memcpy(&config, given, sizeof config);
  }
  std::string channel = config.channel != nullptr ? config.channel : "";
  if (channel.empty()) channel = "UNISIM_IMAGE";
  check_channel(channel);
  Url url = parse_url(config.url, Direction::kSubscribe);
  std::vector<std::string> notes;
  ask_for_room(&url, &notes);
  return new Subscriber(open_network(url), channel, notes);
}

}  // namespace
}  // namespace unisim::lcm

unisim_source* unisim_lcm_subscribe(const unisim_lcm_subscriber_config* config, int32_t* problem,
                                    char* message, size_t capacity) {
  return unisim::lcm::create(problem, message, capacity, [&] { return unisim::lcm::make(config); });
}

const char* unisim_lcm_subscriber_note(const unisim_source* source, int32_t i) {
  const auto& notes = static_cast<const unisim::lcm::Subscriber*>(source)->notes();
  return i >= 0 && static_cast<size_t>(i) < notes.size() ? notes[static_cast<size_t>(i)].c_str()
                                                         : nullptr;
}

void unisim_lcm_subscriber_get_counts(const unisim_source* source,
                                      unisim_lcm_subscriber_counts* counts) {
  unisim::drivers::copy_out(static_cast<const unisim::lcm::Subscriber*>(source)->counts(), counts);
}
