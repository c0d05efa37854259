// SPDX-License-Identifier: MIT
// What an odometer has said: where it was, or how far it had gone, at times.
#include "drivers/pipeline/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "drivers/pipeline/similarity.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::pipeline {
namespace {

using sequence::InputError;

constexpr double kLongestGap_s = 1.0;
constexpr size_t kMostColumns = 8;
constexpr double kFastest = 100.0;  // metres per second

[[noreturn]] void refuse(const std::string& path, int64_t line, const std::string& why) {
  throw InputError(path + ":" + std::to_string(line) + ": " + why +
                   "; lines are \"time path\", \"time x y [z]\" or TUM poses");
}

double seconds(int64_t time_ns) { return 1e-9 * static_cast<double>(time_ns); }

std::vector<double> numbers_of(const std::string& path, const sequence::TextLine& line) {
  std::vector<double> numbers;
  for (const std::string_view field : sequence::split_fields(line.text, true)) {
    double value = 0.0;
    if (!sequence::parse_number(field, &value) || !std::isfinite(value)) {
      refuse(path, line.number, "\"" + std::string(field) + "\" is no number");
    }
    numbers.push_back(value);
  }
  const size_t count = numbers.size();
  if (count < 2 || count > kMostColumns || (count > 4 && count != kMostColumns)) {
    refuse(path, line.number, std::to_string(count) + " numbers");
  }
  return numbers;
}

}  // namespace

Odometry Odometry::read(const std::string& path) {
  Odometry odometry;
  size_t columns = 0;
  for (const sequence::TextLine& line : sequence::read_lines(path)) {
    const std::vector<double> numbers = numbers_of(path, line);
    if (columns == 0) columns = numbers.size();
    if (numbers.size() != columns) refuse(path, line.number, "not as many numbers as before");
    Entry entry;
    entry.time_s = numbers[0];
    if (!odometry.entries_.empty() && !(entry.time_s > odometry.entries_.back().time_s)) {
      refuse(path, line.number, "time does not grow");
    }
    if (columns == 2) {
      entry.travelled.path = numbers[1];
    } else {
      for (size_t k = 0; k + 1 < std::min<size_t>(columns, 4); ++k) {
        entry.travelled.position[k] = numbers[k + 1];
      }
      if (!odometry.entries_.empty()) {
        const Travelled& before = odometry.entries_.back().travelled;
        entry.travelled.path =
            before.path + distance(before.position.data(), entry.travelled.position.data());
      }
    }
    odometry.entries_.push_back(entry);
  }
  if (odometry.entries_.size() < 2) throw InputError(path + ": fewer than two lines of odometry");
  odometry.has_positions_ = columns > 2;
  return odometry;
}

void Odometry::add(const OdometryStep& step) {
  const double from_s = seconds(step.from_ns);
  Entry last = entries_.empty() ? Entry() : entries_.back();
  if (entries_.empty() || from_s > last.time_s) {
    last.time_s = from_s;
    ++last.travelled.stretch;
    entries_.push_back(last);
  }
  last.time_s = seconds(step.to_ns);
  last.travelled.path += step.metres;
  last.travelled.sigma += step.sigma * step.metres;
  keep(last);
}

void Odometry::add(const OdometryPosition& position) {
  Entry next;
  next.time_s = seconds(position.time_ns);
  next.travelled.position = position.position;
  has_positions_ = true;
  if (!entries_.empty()) {
    const Entry& last = entries_.back();
    const double step = distance(last.travelled.position.data(), position.position.data());
    const bool set_back = !(step <= kFastest * (next.time_s - last.time_s));
    next.travelled.path = last.travelled.path + (set_back ? 0.0 : step);
    next.travelled.stretch = last.travelled.stretch + (set_back ? 1 : 0);
  }
  keep(next);
}

void Odometry::keep(const Entry& newest) {
  entries_.push_back(newest);
  while (entries_.size() > kMostSteps) entries_.pop_front();
}

bool Odometry::ends_before(int64_t timestamp_ns) const {
  return entries_.empty() || entries_.back().time_s < seconds(timestamp_ns);
}

bool Odometry::at(int64_t timestamp_ns, Travelled* travelled) const {
  const double time_s = seconds(timestamp_ns);
  const auto after = std::lower_bound(entries_.begin(), entries_.end(), time_s,
                                      [](const Entry& e, double t) { return e.time_s < t; });
  if (after == entries_.end()) return false;
  if (after->time_s == time_s) {
    *travelled = after->travelled;
    return true;
  }
  if (after == entries_.begin()) return false;
  const Entry& before = *(after - 1);
  const double gap = after->time_s - before.time_s;
  if (gap > kLongestGap_s || before.travelled.stretch != after->travelled.stretch) return false;
  const double share = (time_s - before.time_s) / gap;
  const auto between = [share](double a, double b) { return a + share * (b - a); };
  for (size_t k = 0; k < 3; ++k) {
    travelled->position[k] = between(before.travelled.position[k], after->travelled.position[k]);
  }
  travelled->path = between(before.travelled.path, after->travelled.path);
  travelled->sigma = between(before.travelled.sigma, after->travelled.sigma);
  travelled->stretch = before.travelled.stretch;
  return true;
}

}  // namespace unisim::pipeline
