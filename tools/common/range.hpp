// SPDX-License-Identifier: MIT
// Numbers that people give, and the range in which each must lie.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace unisim::tools {

/// Where a number must lie. NaN lies nowhere.
class Range {
 public:
  /// low <= x <= high
  static Range whole(int64_t low, int64_t high) {
    return {static_cast<double>(low), static_cast<double>(high), true, true};
  }
  static Range number(double low, double high) { return {low, high, true, false}; }
  /// low < x <= high
  static Range above(double low, double high) { return {low, high, false, false}; }
  /// 0 too, which means something of its own.
  Range or_zero() const;

  bool holds(double value) const;
  bool is_whole() const { return whole_; }
  double low() const { return low_; }
  double high() const { return high_; }

  /// "a whole number from 2 to 64, or 0"
  std::string text() const;

 private:
  Range(double low, double high, bool with_low, bool whole)
      : low_(low), high_(high), with_low_(with_low), whole_(whole) {}

  double low_;
  double high_;
  bool with_low_;
  bool whole_;
  bool zero_ = false;
};

/// A number of a command line or file: decimal, the whole text. Whole numbers may begin with zeros.
std::optional<int64_t> parse_whole(const std::string& text);
std::optional<double> parse_number(const std::string& text);

}  // namespace unisim::tools
