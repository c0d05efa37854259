// SPDX-License-Identifier: MIT
// Numbers that people give, and the range in which each must lie.
#include "tools/common/range.hpp"

#include <charconv>
#include <system_error>

#include "drivers/common/format.hpp"

namespace unisim::tools {
namespace {

template <typename Number>
std::optional<Number> parse(const std::string& text) {
  const char* const begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* const end = text.data() + text.size();
  Number value{};
  const auto [stop, problem] = std::from_chars(begin, end, value);
  if (problem != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace

Range Range::or_zero() const {
  Range range = *this;
  range.zero_ = true;
  return range;
}

bool Range::holds(double value) const {
  if (zero_ && value == 0.0) return true;
  return (with_low_ ? value >= low_ : value > low_) && value <= high_;
}

std::string Range::text() const {
  const char* const pattern = whole_      ? "a whole number from %.15g to %.15g"
                              : with_low_ ? "a number from %g to %g"
                                          : "a number above %g and up to %g";
  return drivers::format(pattern, low_, high_) + (zero_ ? ", or 0" : "");
}

std::optional<int64_t> parse_whole(const std::string& text) { return parse<int64_t>(text); }

std::optional<double> parse_number(const std::string& text) { return parse<double>(text); }

}  // namespace unisim::tools
