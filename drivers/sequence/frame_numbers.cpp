// SPDX-License-Identifier: MIT
// The number in the name of an image: it, not the place in the listing, says which frame it is.
#include "drivers/sequence/frame_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>

namespace unisim::sequence {
namespace {

constexpr std::string_view kDigits = "0123456789";

// Larger numbers are dates or counts of a clock: ten days at a thousand images a second.
constexpr int64_t kLargestSpan = 1000000000;

// A name as text, digits, text, digits, ...; numbers at odd places.
std::vector<std::string_view> split_name(std::string_view name) {
  name = name.substr(0, name.find_last_of('.'));
  std::vector<std::string_view> parts;
  size_t at = 0;
  while (at <= name.size()) {
    const bool number = parts.size() % 2 == 1;
    const size_t end =
        std::min(number ? name.find_first_not_of(kDigits, at) : name.find_first_of(kDigits, at),
                 name.size());
    parts.push_back(name.substr(at, end - at));
    if (end == name.size()) break;
    at = end;
  }
  return parts;
}

// Marks where `b` differs from `a`. @return false when text does, or the number of parts
bool mark_differences(const std::vector<std::string_view>& a,
                      const std::vector<std::string_view>& b, std::vector<bool>* differs) {
  if (a.size() != b.size()) return false;
  for (size_t k = 0; k < a.size(); ++k) {
    if (a[k] == b[k]) continue;
    if (k % 2 == 0) return false;
    (*differs)[k] = true;
  }
  return true;
}

}  // namespace

std::vector<int64_t> positions(size_t count) {
  std::vector<int64_t> out(count);
  std::iota(out.begin(), out.end(), 0);
  return out;
}

std::vector<int64_t> frame_numbers(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  const std::vector<std::string_view> first = split_name(names.front());
  if (first.size() < 2) return {};
  std::vector<bool> differs(first.size(), false);
  for (const std::string& name : names) {
    if (!mark_differences(first, split_name(name), &differs)) return {};
  }
  const auto marked = std::count(differs.begin(), differs.end(), true);
  if (marked > 1) return {};
  // One image, or the same number with several endings: the last number.
  const size_t place =
      marked == 1
          ? static_cast<size_t>(std::find(differs.begin(), differs.end(), true) - differs.begin())
          : (first.size() / 2) * 2 - 1;
  std::vector<int64_t> numbers;
  for (const std::string& name : names) {
    const std::string_view digits = split_name(name)[place];
    int64_t number = 0;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (result.ec != std::errc()) return {};
    numbers.push_back(number);
  }
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  if (*most - *least > kLargestSpan) return {};
  return numbers;
}

void note_gaps(const std::vector<int64_t>& numbers, Recording* recording) {
  if (numbers.empty()) return;
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
  const int64_t span = *most - *least + 1;
  if (span <= static_cast<int64_t>(numbers.size())) return;
  add_note(recording, "images are numbered " + std::to_string(*least) + " to " +
                          std::to_string(*most) + " and " + std::to_string(numbers.size()) +
                          " of these " + std::to_string(span) +
                          " are there: each has the time of its number");
}

std::vector<int64_t> lines_of_images(const std::vector<std::string>& names, size_t lines,
                                     const std::string& list_path, Recording* recording,
                                     std::string* problem) {
  std::vector<int64_t> numbers = frame_numbers(names);
  if (!numbers.empty() && numbers.back() < static_cast<int64_t>(lines)) {
    note_gaps(numbers, recording);
    return numbers;
  }
  const std::string both = list_path + ": " + std::to_string(lines) + " lines for " +
                           std::to_string(names.size()) + " images " +
                           (numbers.empty() ? "without a number of their own"
                                            : "numbered " + std::to_string(numbers.front()) +
                                                  " to " + std::to_string(numbers.back()));
  if (lines == names.size()) {
    add_note(recording, both + ": paired in order");
    return positions(lines);
  }
  *problem = both + ": a line for each number from 0 is needed, or as many lines as images";
  return {};
}

}  // namespace unisim::sequence
