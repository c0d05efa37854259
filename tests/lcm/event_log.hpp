// SPDX-License-Identifier: MIT
// LCM event logs as the format says, byte by byte: independent of what is under test.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace unisim::testing {

struct LogEvent {
  std::string channel;
  std::string data;
};

/// All events of a whole log. Throws where it is not one.
std::vector<LogEvent> read_log(const std::string& path);

/// Those of one channel.
std::vector<std::string> messages_on(const std::string& channel, const std::string& path);

/// One event as it lies in a log.
std::string event_bytes(int64_t number, int64_t utime, const std::string& channel,
                        const std::string& data);

/// Numbers as they lie on the wire: most significant byte first.
std::string big_endian(uint64_t value, int bytes);
std::string wire(int64_t value);
std::string wire(int32_t value);
std::string wire(double value);

}  // namespace unisim::testing
