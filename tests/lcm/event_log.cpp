// SPDX-License-Identifier: MIT
// LCM event logs as the format says.
#include "tests/lcm/event_log.hpp"

#include <cstring>
#include <stdexcept>

#include "tests/support/temp_folder.hpp"

namespace unisim::testing {
namespace {

constexpr uint64_t kSync = 0xEDA1DA01;

uint64_t take(const std::string& bytes, size_t* at, size_t count) {
  if (*at + count > bytes.size()) throw std::runtime_error("log is cut off");
  uint64_t value = 0;
  for (size_t k = 0; k < count; ++k) {
    value = (value << 8) | static_cast<unsigned char>(bytes[(*at)++]);
  }
  return value;
}

}  // namespace

std::string big_endian(uint64_t value, int bytes) {
  std::string out;
  for (int k = bytes - 1; k >= 0; --k) out += static_cast<char>(value >> (8 * k));
  return out;
}

std::string wire(int64_t value) { return big_endian(static_cast<uint64_t>(value), 8); }

std::string wire(int32_t value) { return big_endian(static_cast<uint32_t>(value), 4); }

std::string wire(double value) {
  uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return big_endian(bits, 8);
}

std::string event_bytes(int64_t number, int64_t utime, const std::string& channel,
                        const std::string& data) {
  return big_endian(kSync, 4) + wire(number) + wire(utime) +
         wire(static_cast<int32_t>(channel.size())) + wire(static_cast<int32_t>(data.size())) +
         channel + data;
}

std::vector<LogEvent> read_log(const std::string& path) {
  const std::string bytes = read_file(path);
  std::vector<LogEvent> events;
  for (size_t at = 0; at < bytes.size();) {
    if (take(bytes, &at, 4) != kSync) throw std::runtime_error("no event where one should begin");
    at += 16;
    const size_t channel = take(bytes, &at, 4);
    const size_t data = take(bytes, &at, 4);
    if (at + channel + data > bytes.size()) throw std::runtime_error("log is cut off");
    events.push_back({bytes.substr(at, channel), bytes.substr(at + channel, data)});
    at += channel + data;
  }
  return events;
}

std::vector<std::string> messages_on(const std::string& channel, const std::string& path) {
  std::vector<std::string> out;
  for (const LogEvent& event : read_log(path)) {
    if (event.channel == channel) out.push_back(event.data);
  }
  return out;
}

}  // namespace unisim::testing
