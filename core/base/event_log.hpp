// SPDX-License-Identifier: MIT
// One-line messages put together without the C library's formatting.
#pragma once

#include <cstdint>

namespace unisim {

/// Numbers of UNISIM_LOG_*.
enum class LogLevel : int32_t { kInfo = 1, kWarning = 2 };

/// The host's log callback.
struct LogSink {
  void (*call)(int32_t level, const char* text, void* user) = nullptr;
  void* user = nullptr;
};

/// A line of text in a fixed buffer; what does not fit is cut off.
class LogLine {
 public:
  LogLine& operator<<(const char* text);
  LogLine& operator<<(int32_t value);
  /// Four decimals.
  LogLine& operator<<(double value);

  void send(const LogSink& sink, LogLevel level) const {
    if (sink.call != nullptr) sink.call(static_cast<int32_t>(level), text_, sink.user);
  }

 private:
  void put(char c);
  void put_unsigned(uint64_t value, int32_t least_digits);

  static constexpr int32_t kCapacity = 160;
  char text_[kCapacity] = {};
  int32_t size_ = 0;
};

}  // namespace unisim
