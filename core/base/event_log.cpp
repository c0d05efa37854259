// SPDX-License-Identifier: MIT
// One-line messages put together without the C library's formatting.
#include "core/base/event_log.hpp"

namespace unisim {

void LogLine::put(char c) {
  if (size_ + 1 < kCapacity) text_[size_++] = c;
}

void LogLine::put_unsigned(uint64_t value, int32_t least_digits) {
  char digits[20];
  int32_t count = 0;
  do {
    digits[count++] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value != 0 || count < least_digits);
  while (count > 0) put(digits[--count]);
}

LogLine& LogLine::operator<<(const char* text) {
  while (*text != '\0') put(*text++);
  return *this;
}

LogLine& LogLine::operator<<(int32_t value) {
  if (value < 0) put('-');
  const auto wide = static_cast<int64_t>(value);
  put_unsigned(static_cast<uint64_t>(wide < 0 ? -wide : wide), 1);
  return *this;
}

LogLine& LogLine::operator<<(double value) {
  constexpr double kUnits = 10000.0;  // four decimals
  constexpr double kLargest = 1e12;
  if (value < 0.0) put('-');
  const double magnitude = value < 0.0 ? -value : value;
  if (!(magnitude < kLargest)) return *this << "huge";
  const auto units = static_cast<uint64_t>(magnitude * kUnits + 0.5);
  put_unsigned(units / 10000, 1);
  put('.');
  put_unsigned(units % 10000, 4);
  return *this;
}

}  // namespace unisim
