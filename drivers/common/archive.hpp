// SPDX-License-Identifier: MIT
// Numbers of one fixed layout through a callback, in either direction: what a class says of itself
// once is both how it is saved and how it is loaded.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace unisim::drivers {

/// Ids of keyframes stay below: there is room for sums with it.
inline constexpr int32_t kMostKeyframeId = 1 << 30;

/// What an archive throws: the part, and why.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Little-endian, without padding. Whatever is read may be hostile: it is checked by require()
/// before it is used, and nothing is believed of its lengths.
class Archive {
 public:
  using Write = int32_t (*)(void* context, const void* bytes, size_t size);
  using Read = int32_t (*)(void* context, void* bytes, size_t size);

  /// @param write 1: all of it was taken, 0: not
  Archive(Write write, void* context) : write_(write), context_(context) {}
  /// @param read 1: all of it was given, 0: not
  Archive(Read read, void* context) : read_(read), context_(context) {}

  bool reading() const { return read_ != nullptr; }

  /// Names what follows, in messages.
  void part(const char* name) { part_ = name; }

  void bytes(void* data, size_t size) {
    if (size == 0) return;
    if (reading() && read_(context_, data, size) == 0) fail("ends too early");
    if (!reading() && write_(context_, data, size) == 0) fail("could not be written");
  }

  /// An integer or a floating-point number, bit by bit.
  template <typename T>
  void number(T& value) {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    unsigned char raw[sizeof(T)];
    if (!reading()) pack(value, raw);
    bytes(raw, sizeof raw);
    if (reading()) unpack(raw, &value);
  }
  /// @param most the largest it may be, and `least` the least, when it is read
  void number(int32_t& value, int32_t least, int32_t most) {
    number(value);
    require(value >= least && value <= most, "a number is out of range");
  }
  void number(double& value, double least, double most) {
    number(value);
    require(value >= least && value <= most, "a number is out of range");
  }
  void flag(bool& value) {
    uint8_t raw = value ? 1 : 0;
    number(raw);
    require(raw <= 1, "a flag is neither set nor clear");
    value = raw != 0;
  }

  /// When reading: throws unless `good`.
  void require(bool good, const char* why) const {
    if (reading() && !good) fail(why);
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw ArchiveError(std::string(part_) + ": " + why);
  }

 private:
  template <typename T>
  using Bits =
      std::conditional_t<sizeof(T) == 8, uint64_t,
                         std::conditional_t<sizeof(T) == 4, uint32_t,
                                            std::conditional_t<sizeof(T) == 2, uint16_t, uint8_t>>>;

  template <typename T>
  static void pack(const T& value, unsigned char* raw) {
    Bits<T> bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (size_t k = 0; k < sizeof bits; ++k) raw[k] = static_cast<unsigned char>(bits >> (8 * k));
  }
  template <typename T>
  static void unpack(const unsigned char* raw, T* value) {
    uint64_t bits = 0;
    for (size_t k = 0; k < sizeof(T); ++k) bits |= static_cast<uint64_t>(raw[k]) << (8 * k);
    const auto narrow = static_cast<Bits<T>>(bits);
    std::memcpy(value, &narrow, sizeof narrow);
  }

  Write write_ = nullptr;
  Read read_ = nullptr;
  void* context_ = nullptr;
  const char* part_ = "";
};

}  // namespace unisim::drivers
