// SPDX-License-Identifier: MIT
// A map as a stream of numbers.
#include "core/snapshot/archive.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace unisim {
namespace {

constexpr unsigned char kMagic[8] = {'u', 'n', 'i', 'm', 'a', 'p', '\r', '\n'};
constexpr uint32_t kVersion = 1;         // of the order of sections
constexpr uint32_t kSectionVersion = 1;  // of each of them

constexpr size_t kNameBytes = 8;
constexpr size_t kCrcAt = 12;
constexpr size_t kSizeAt = 16;
constexpr size_t kHeaderBytes = 24;

template <class Unsigned>
void put(Unsigned value, unsigned char* bytes) {
  for (size_t i = 0; i < sizeof value; ++i) {
    bytes[i] = static_cast<unsigned char>(static_cast<uint64_t>(value) >> (8 * i));
  }
}

template <class Unsigned>
Unsigned get(const unsigned char* bytes) {
  uint64_t value = 0;
  for (size_t i = 0; i < sizeof(Unsigned); ++i) value |= static_cast<uint64_t>(bytes[i]) << (8 * i);
  return static_cast<Unsigned>(value);
}

// Where there is no operating system there may be no memcmp().
bool same_bytes(const unsigned char* a, const unsigned char* b, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    if (a[i] != b[i]) return false;
  }
  return true;
}

}  // namespace

void Archive::note(LoadProblem problem, const char* setting, int64_t needed, int64_t given) {
  if (!ok()) return;
  report_ = {problem, name_, setting, needed, given};
}

void Archive::require(bool holds, LoadProblem problem) {
  if (loading() && !holds) note(problem, "", 0, 0);
}

void Archive::need(const char* setting, int64_t needed, int64_t given) {
  if (loading() && needed > given) note(LoadProblem::kCapacity, setting, needed, given);
}

void Archive::same(const char* setting, int32_t ours) {
  int32_t saved = ours;
  value(&saved);
  fits(setting, saved == ours, saved, ours);
}

void Archive::fits(const char* setting, bool is_so, int64_t needed, int64_t given) {
  if (loading() && !is_so) note(LoadProblem::kSetting, setting, needed, given);
}

void Archive::at_least(const char* setting, int32_t ours) {
  int32_t saved = ours;
  value(&saved);
  need(setting, saved, ours);
}

void Archive::magic() {
  unsigned char start[sizeof kMagic + sizeof kVersion];
  std::memcpy(start, kMagic, sizeof kMagic);
  put(kVersion, start + sizeof kMagic);
  if (!loading()) {
    if (write_(context_, start, sizeof start) != 1) note(LoadProblem::kEnd, "", 0, 0);
    return;
  }
  fetch(start, sizeof start);
  require(same_bytes(start, kMagic, sizeof kMagic), LoadProblem::kMagic);
  require(get<uint32_t>(start + sizeof kMagic) == kVersion, LoadProblem::kVersion);
}

void Archive::fetch(unsigned char* data, size_t count) {
  if (ok() && read_(context_, data, count) != 1) note(LoadProblem::kEnd, "", 0, 0);
  if (!ok()) std::memset(data, 0, count);
}

void Archive::open(const char* name) {
  name_ = name;
  crc_ = Crc32();
  size_ = 0;
  measuring_ = !loading();
  unsigned char expected[kNameBytes] = {};
  for (size_t k = 0; k < kNameBytes && name[k] != '\0'; ++k) {
    expected[k] = static_cast<unsigned char>(name[k]);
  }
  if (!loading()) {
    std::memcpy(header_, expected, kNameBytes);
    return;
  }
  fetch(header_, kHeaderBytes);
  require(same_bytes(header_, expected, kNameBytes), LoadProblem::kContent);
  require(get<uint32_t>(header_ + kNameBytes) == kSectionVersion, LoadProblem::kVersion);
  if (ok()) size_ = get<uint64_t>(header_ + kSizeAt);
}

/// Behind the payload, so that one pass over it finds both size and checksum.
void Archive::close_checksum(const unsigned char* header) {
  crc_.add(header, kCrcAt);
  crc_.add(header + kSizeAt, sizeof(uint64_t));
}

void Archive::write_header() {
  put(kSectionVersion, header_ + kNameBytes);
  put(size_, header_ + kSizeAt);
  close_checksum(header_);
  put(crc_.value(), header_ + kCrcAt);
  measuring_ = false;
  bytes(header_, kHeaderBytes);
}

void Archive::close() {
  if (!loading()) {
    flush();
    return;
  }
  require(size_ == 0 && buffer_begin_ == buffer_end_, LoadProblem::kContent);
  close_checksum(header_);
  require(get<uint32_t>(header_ + kCrcAt) == crc_.value(), LoadProblem::kChecksum);
}

void Archive::flush() {
  if (buffer_end_ > 0 && ok() && write_(context_, buffer_, buffer_end_) != 1) {
    note(LoadProblem::kEnd, "", 0, 0);
  }
  buffer_end_ = 0;
}

void Archive::bytes(unsigned char* data, size_t count) {
  if (measuring_) {
    crc_.add(data, count);
    size_ += count;
    return;
  }
  if (!loading()) {
    if (buffer_end_ + count > sizeof buffer_) flush();
    std::memcpy(buffer_ + buffer_end_, data, count);
    buffer_end_ += count;
    return;
  }
  size_t got = 0;
  while (ok() && got < count) {
    if (buffer_begin_ == buffer_end_) {
      require(size_ > 0, LoadProblem::kContent);
      buffer_begin_ = 0;
      buffer_end_ = static_cast<size_t>(std::min<uint64_t>(size_, sizeof buffer_));
      fetch(buffer_, buffer_end_);
      crc_.add(buffer_, buffer_end_);
      size_ -= buffer_end_;
    }
    const size_t piece = std::min(count - got, buffer_end_ - buffer_begin_);
    std::memcpy(data + got, buffer_ + buffer_begin_, piece);
    buffer_begin_ += piece;
    got += piece;
  }
  if (!ok()) std::memset(data, 0, count);
}

template <class Unsigned>
void Archive::number(Unsigned* v) {
  unsigned char raw[sizeof(Unsigned)] = {};
  if (!loading()) put(*v, raw);
  bytes(raw, sizeof raw);
  if (loading()) *v = get<Unsigned>(raw);
}

void Archive::value(uint8_t* v) { number(v); }
void Archive::value(uint16_t* v) { number(v); }
void Archive::value(uint32_t* v) { number(v); }
void Archive::value(uint64_t* v) { number(v); }

void Archive::value(int32_t* v) {
  auto bits = static_cast<uint32_t>(*v);
  number(&bits);
  if (loading()) *v = static_cast<int32_t>(bits);
}

void Archive::value(int64_t* v) {
  auto bits = static_cast<uint64_t>(*v);
  number(&bits);
  if (loading()) *v = static_cast<int64_t>(bits);
}

void Archive::value(float* v) {
  uint32_t bits = 0;
  std::memcpy(&bits, v, sizeof bits);
  number(&bits);
  if (loading()) std::memcpy(v, &bits, sizeof bits);
}

void Archive::value(double* v) {
  uint64_t bits = 0;
  std::memcpy(&bits, v, sizeof bits);
  number(&bits);
  if (loading()) std::memcpy(v, &bits, sizeof bits);
}

void Archive::flag(bool* v) {
  uint8_t bit = *v ? 1 : 0;
  value(&bit);
  expect(bit <= 1);
  if (loading()) *v = bit == 1;
}

void Archive::index(int32_t* v, int32_t first, int32_t last) {
  value(v);
  expect(*v >= first && *v <= last);
  if (loading() && !ok()) *v = first;
}

void Archive::finite(double* v) {
  value(v);
  expect(std::isfinite(*v));
}

void Archive::log_ratio(double* v) {
  constexpr double kLargest = 70.0;  // Sim3::in_range(): 1e30
  value(v);
  expect(std::abs(*v) <= kLargest);
}

void Archive::pose(Sim3* T) {
  for (int k = 0; k < 4; ++k) value(&T->q.coeffs()[k]);
  for (int k = 0; k < 3; ++k) value(&T->t[k]);
  value(&T->s);
  if (loading() && !(ok() && T->in_range())) {
    expect(false);
    *T = Sim3();
  }
}

}  // namespace unisim
