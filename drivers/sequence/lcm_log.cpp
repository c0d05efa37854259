// SPDX-License-Identifier: MIT
// LCM event logs: where the images lie.
#include "drivers/sequence/lcm_log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/lcm_image.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

// Of an event: sync word, number, time, length of the channel's name, length of the message.
constexpr std::array<uint8_t, 4> kSync = {0xED, 0xA1, 0xDA, 0x01};
constexpr int64_t kHeadBytes = 28;
constexpr int64_t kLongestChannel = 63;
constexpr int64_t kLargestMessage = 1 << 28;  // LCM_MAX_MESSAGE_SIZE
constexpr int64_t kLastMicrosecond = std::numeric_limits<int64_t>::max() / 1000;
constexpr const char* kUsualChannel = "UNISIM_IMAGE";

struct Event {
  int64_t utime;  // when it was logged
  std::string channel;
  int64_t data_offset;
  int64_t data_size;
};

/// What was found on one channel.
struct Channel {
  std::vector<LoggedImage> images;
  std::vector<int64_t> logged_ns;  // of each image
  int64_t others = 0;              // messages of other types
  bool has_times = false;          // some image has a time of its own
};

class LogScan {
 public:
  explicit LogScan(const std::string& path)
      : path_(path), file_(path, std::ios::binary | std::ios::ate) {
    if (!file_ || !is_file(path)) {
      throw InputError(path + ": cannot be read: " + std::strerror(errno != 0 ? errno : ENOENT));
    }
    size_ = static_cast<int64_t>(file_.tellg());
  }

  void run();
  const std::map<std::string, Channel>& channels() const { return channels_; }
  std::optional<std::string> damage() const;

 private:
  bool read(int64_t at, void* bytes, int64_t count);
  bool event_at(int64_t at, Event* event);
  int64_t next_sync(int64_t at);
  void take(const Event& event);

  const std::string& path_;
  std::ifstream file_;
  int64_t size_ = 0;
  std::map<std::string, Channel> channels_;
  int64_t first_damage_ = -1;
  int64_t damaged_places_ = 0;
  int64_t lost_bytes_ = 0;
};

bool LogScan::read(int64_t at, void* bytes, int64_t count) {
  if (at + count > size_) return false;
  file_.clear();
  file_.seekg(at);
  file_.read(static_cast<char*>(bytes), count);
  return static_cast<bool>(file_);
}

/// A whole event with lengths that make sense.
bool LogScan::event_at(int64_t at, Event* event) {
  std::array<uint8_t, kHeadBytes> head{};
  if (!read(at, head.data(), kHeadBytes)) return false;
  if (!std::equal(kSync.begin(), kSync.end(), head.begin())) return false;
  const auto name = static_cast<int64_t>(read_big_endian(&head[20], 4));
  event->utime = static_cast<int64_t>(read_big_endian(&head[12], 8));
  event->data_offset = at + kHeadBytes + name;
  event->data_size = static_cast<int64_t>(read_big_endian(&head[24], 4));
  const bool sane = name >= 1 && name <= kLongestChannel && event->data_size <= kLargestMessage &&
                    event->data_offset + event->data_size <= size_;
  if (!sane) return false;
  event->channel.resize(static_cast<size_t>(name));
  return read(at + kHeadBytes, event->channel.data(), name);
}

/// Where an event may begin again, from `at` on; the end of the file if nowhere.
int64_t LogScan::next_sync(int64_t at) {
  std::array<uint8_t, 1 << 16> block{};
  while (at < size_) {
    const int64_t count = std::min<int64_t>(block.size(), size_ - at);
    if (!read(at, block.data(), count)) break;
    const auto end = block.begin() + count;
    const auto found = std::search(block.begin(), end, kSync.begin(), kSync.end());
    if (found != end) return at + (found - block.begin());
    if (count < static_cast<int64_t>(block.size())) break;
    at += count - static_cast<int64_t>(kSync.size() - 1);
  }
  return size_;
}

void LogScan::take(const Event& event) {
  Channel& channel = channels_[event.channel];
  std::array<uint8_t, kImageHeadBytes> head{};
  const bool whole = event.data_size >= static_cast<int64_t>(head.size()) &&
                     read(event.data_offset, head.data(), static_cast<int64_t>(head.size()));
  const int64_t utime = image_utime(head.data());
  if (!whole || !is_image_message(head.data(), head.size()) || utime > kLastMicrosecond ||
      utime < -kLastMicrosecond) {
    ++channel.others;
    return;
  }
  channel.has_times = channel.has_times || utime != 0;
  channel.images.push_back({1000 * utime, event.data_offset, event.data_size});
  channel.logged_ns.push_back(1000 * std::clamp(event.utime, -kLastMicrosecond, kLastMicrosecond));
}

void LogScan::run() {
  for (int64_t at = 0; at < size_;) {
    Event event;
    if (event_at(at, &event)) {
      take(event);
      at = event.data_offset + event.data_size;
      continue;
    }
    if (damaged_places_++ == 0) first_damage_ = at;
    const int64_t next = next_sync(at + 1);
    lost_bytes_ += next - at;
    at = next;
  }
}

std::optional<std::string> LogScan::damage() const {
  if (damaged_places_ == 0) return std::nullopt;
  return path_ + ": damaged or cut off at offset " + std::to_string(first_damage_) +
         (damaged_places_ > 1 ? " and " + std::to_string(damaged_places_ - 1) + " other places"
                              : "") +
         ": " + std::to_string(lost_bytes_) + " of " + std::to_string(size_) + " bytes left out";
}

/// "A (12), B (7)" of the channels with images.
std::string image_channels(const std::map<std::string, Channel>& channels) {
  std::string text;
  for (const auto& [name, channel] : channels) {
    if (channel.images.empty()) continue;
    text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(channel.images.size()) + ")";
  }
  return text;
}

std::string choose_channel(const std::string& path, const std::string& wanted,
                           const std::map<std::string, Channel>& channels) {
  const std::string with_images = image_channels(channels);
  if (with_images.empty()) {
    throw InputError(path + ": no image among " + std::to_string(channels.size()) +
                     " channels: give a log with messages of type bot_core.image_t");
  }
  const auto has_images = [&](const std::string& name) {
    const auto found = channels.find(name);
    return found != channels.end() && !found->second.images.empty();
  };
  if (!wanted.empty()) {
    if (has_images(wanted)) return wanted;
    throw InputError(path + ": no image on channel '" + wanted +
                     "': give one of these with --lcm-image-channel: " + with_images);
  }
  if (has_images(kUsualChannel)) return kUsualChannel;
  if (with_images.find(", ") != std::string::npos) {
    throw InputError(path + ": images on several channels: give one of these with " +
                     "--lcm-image-channel: " + with_images);
  }
  return with_images.substr(0, with_images.rfind(" ("));
}

}  // namespace

bool begins_as_lcm_log(const std::string& path) {
  std::array<uint8_t, kSync.size()> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  return file && head == kSync;
}

LcmLog list_lcm_log(const std::string& path, const std::string& channel) {
  LogScan scan(path);
  scan.run();
  LcmLog log;
  const std::optional<std::string> damage = scan.damage();
  if (damage) log.notes.push_back(*damage);
  log.channel = choose_channel(path, channel, scan.channels());
  const Channel& chosen = scan.channels().at(log.channel);
  log.images = chosen.images;
  if (!chosen.has_times) {
    for (size_t k = 0; k < log.images.size(); ++k) {
      log.images[k].timestamp_ns = chosen.logged_ns[k];
    }
    log.notes.push_back(path + ": images of channel '" + log.channel +
                        "' have no times: those of the log are taken");
  }
  if (chosen.others > 0) {
    log.notes.push_back(path + ": " + std::to_string(chosen.others) + " messages on channel '" +
                        log.channel + "' are no images: left out");
  }
  return log;
}

}  // namespace unisim::sequence
