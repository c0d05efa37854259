// SPDX-License-Identifier: MIT
// Times as text: exact to the nanosecond, in the unit that a whole list is found to be written in.
#include "drivers/sequence/time_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "drivers/common/median.hpp"

namespace unisim::sequence {
namespace {

constexpr TimeUnit kUnits[] = {TimeUnit::kSeconds, TimeUnit::kMilliseconds, TimeUnit::kMicroseconds,
                               TimeUnit::kNanoseconds};
constexpr double kFirstDateS = 1e9;         // September 2001
constexpr double kLastDateS = 4.1e9;        // December 2099
constexpr double kShortestStepS = 2e-4;     // 5000 images a second
constexpr double kLongestDateStepS = 1000;  // a date is hardly anything else
constexpr uint64_t kMaxNs = 9200000000000000000u;
constexpr int kMaxExponent = 400;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Number without sign as digits * 10^exponent.
bool parse_decimal(std::string_view text, std::string* digits, int* exponent) {
  size_t at = 0;
  int after_point = 0;
  bool point = false;
  for (; at < text.size() && (is_digit(text[at]) || (text[at] == '.' && !point)); ++at) {
    if (text[at] == '.') {
      point = true;
    } else {
      digits->push_back(text[at]);
      after_point += point ? 1 : 0;
    }
  }
  *exponent = 0;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    at += text.substr(at + 1, 1) == "+" ? 2 : 1;
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(text.data() + at, end, *exponent);
    if (result.ec != std::errc() || std::abs(*exponent) > kMaxExponent) return false;
    at = static_cast<size_t>(result.ptr - text.data());
  }
  *exponent -= after_point;
  return at == text.size() && !digits->empty();
}

// digits * 10^exponent as a whole number, halves rounded up.
bool to_whole(std::string digits, int exponent, uint64_t* value) {
  bool round_up = false;
  if (exponent < 0) {
    const auto cut = static_cast<size_t>(-exponent);
    round_up = cut <= digits.size() && digits[digits.size() - cut] >= '5';
    digits.resize(digits.size() - std::min(cut, digits.size()));
  }
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  *value = 0;
  if (!digits.empty()) {
    if (exponent > 0) digits.append(static_cast<size_t>(exponent), '0');
    const char* end = digits.data() + digits.size();
    if (std::from_chars(digits.data(), end, *value).ec != std::errc()) return false;
  }
  *value += round_up ? 1 : 0;
  return *value <= kMaxNs;
}

double middle_step(const std::vector<double>& sorted) {
  std::vector<double> steps;
  for (size_t k = 1; k < sorted.size(); ++k) steps.push_back(sorted[k] - sorted[k - 1]);
  return drivers::median(&steps);
}

}  // namespace

const char* unit_name(TimeUnit unit) {
  constexpr const char* kNames[] = {"seconds", "milliseconds", "microseconds", "nanoseconds"};
  return kNames[static_cast<int>(unit)];
}

double units_per_second(TimeUnit unit) {
  constexpr double kPerSecond[] = {1.0, 1e3, 1e6, 1e9};
  return kPerSecond[static_cast<int>(unit)];
}

bool parse_time(std::string_view text, TimeUnit unit, int64_t* ns) {
  const bool negative = text.substr(0, 1) == "-";
  if (negative || text.substr(0, 1) == "+") text.remove_prefix(1);
  std::string digits;
  int exponent = 0;
  uint64_t value = 0;
  if (!parse_decimal(text, &digits, &exponent)) return false;
  if (!to_whole(std::move(digits), exponent + 9 - 3 * static_cast<int>(unit), &value)) return false;
  *ns = negative ? -static_cast<int64_t>(value) : static_cast<int64_t>(value);
  return true;
}

bool is_date(double seconds) { return seconds >= kFirstDateS && seconds <= kLastDateS; }

TimeUnit guess_unit(std::vector<double> times, TimeUnit own, double longest_own_step_s) {
  const auto not_finite = [](double time) { return !std::isfinite(time); };
  times.erase(std::remove_if(times.begin(), times.end(), not_finite), times.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (times.empty()) return own;
  const double largest = std::max(std::abs(times.front()), std::abs(times.back()));
  const bool has_steps = times.size() > 1;
  const double step = has_steps ? middle_step(times) : 0.0;
  const auto possible = [&](TimeUnit unit, double shortest_s, double longest_s) {
    const double per_second = units_per_second(unit);
    if (largest > kLastDateS * per_second) return false;
    return !has_steps || (step >= shortest_s * per_second && step <= longest_s * per_second);
  };
  const bool dated = is_date(times.front() / units_per_second(own));
  if (possible(own, kShortestStepS, dated ? kLongestDateStepS : longest_own_step_s)) return own;
  for (const TimeUnit unit : kUnits) {
    if (possible(unit, 0.0, kLongestImageStepS)) return unit;
  }
  return own;
}

}  // namespace unisim::sequence
