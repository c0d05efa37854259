// SPDX-License-Identifier: MIT
// One line of a graph file, read field by field.
#include "tools/bench/solver/record_reader.hpp"

#include <cmath>

namespace unisim::bench {
namespace {

constexpr double kLargestInteger = 9007199254740992.0;  // beyond it doubles skip integers

}  // namespace

RecordReader::RecordReader(const std::string& path, const sequence::TextLine& line)
    : path_(path), line_(line), fields_(sequence::split_fields(line.text)) {}

void RecordReader::fail(const std::string& what) const {
  throw sequence::InputError(path_ + ":" + std::to_string(line_.number) + ": " + what);
}

void RecordReader::expect_end() const {
  if (!at_end()) fail("more fields than the record has");
}

std::string_view RecordReader::word() {
  if (at_end()) fail("the record ends too early");
  return fields_[next_++];
}

double RecordReader::number() {
  const std::string_view text = word();
  double value = 0.0;
  if (!sequence::parse_number(text, &value) || !std::isfinite(value)) {
    fail("'" + std::string(text) + "' is not a finite number");
  }
  return value;
}

int64_t RecordReader::integer() {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > kLargestInteger) {
    fail("'" + std::string(fields_[next_ - 1]) + "' is not an integer");
  }
  return static_cast<int64_t>(value);
}

int32_t RecordReader::node(const NodeIndex& index) {
  const int64_t id = integer();
  const auto found = index.find(id);
  if (found == index.end()) fail("node " + std::to_string(id) + " is not declared before");
  return found->second;
}

Quat RecordReader::rotation() {
  const double x = number();
  const double y = number();
  const double z = number();
  const double w = number();
  const Quat q(w, x, y, z);
  const double length = q.norm();
  if (!(length > 1e-6) || !std::isfinite(length)) fail("a quaternion has no direction");
  return q.normalized();
}

Vec3 RecordReader::vector() {
  const double x = number();
  const double y = number();
  const double z = number();
  return {x, y, z};
}

}  // namespace unisim::bench
