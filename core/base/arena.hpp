// SPDX-License-Identifier: MIT
// Bump allocator over the caller's memory; the same layout code counts bytes and carves them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>

#include "core/base/span.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define UNISIM_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define UNISIM_ADDRESS_SANITIZER
#endif
#endif

namespace unisim {

/// Bytes taken under one name.
struct ArenaPart {
  const char* name;  ///< static text
  size_t bytes;      ///< padding to the alignment, and gaps, included
};

/// Hands out arrays one after another and never takes one back.
///
/// Without memory behind it ("dry") it only counts: run the layout code on a dry arena to learn the
/// bytes, then on a real one. Arrays of a dry arena have their length and a null pointer: layout
/// code may store them but not touch elements. When the memory runs out, ok() turns false, the
/// counting goes on and arrays are as in a dry arena. A layout of more bytes than can be addressed
/// (on a 32-bit machine a legal configuration gets there) counts as SIZE_MAX bytes and is not ok,
/// dry or not.
class Arena {
 public:
  static constexpr size_t kAlignment = 64;  ///< of every array
  /// Bytes behind each array that nobody may touch; the address sanitizer sees to that, and only
  /// its builds have them.
#ifdef UNISIM_ADDRESS_SANITIZER
  static constexpr size_t kGap = kAlignment;
#else
  static constexpr size_t kGap = 0;
#endif
  static constexpr int32_t kMaxParts = 24;

  Arena() = default;
  /// @param memory caller's, any alignment, lives as long as everything carved from it
  /// @param bytes  its size; required_bytes() of the dry run suffices
  Arena(void* memory, size_t bytes);

  /// Following takes count under this name; a name used before goes on counting. @return *this
  Arena& begin_part(const char* name);

  /// Array of `count` value-initialised elements.
  template <class T>
  Span<T> take(int32_t count) {
    static_assert(std::is_trivially_destructible_v<T>, "nothing runs destructors in an arena");
    static_assert(alignof(T) <= kAlignment, "over-aligned type");
    UNISIM_CHECK(count >= 0);
    void* place = take_bytes(static_cast<size_t>(count), sizeof(T));
    T* data = static_cast<T*>(place);
    if (data != nullptr) {
      for (int32_t i = 0; i < count; ++i) ::new (static_cast<void*>(data + i)) T();
    }
    return Span<T>(data, count);
  }

  /// What was carved from the memory is gone: all of it may be touched again.
  static void give_back(const void* memory, size_t bytes);

  bool dry() const { return memory_ == nullptr; }
  bool ok() const { return ok_; }
  /// Bytes of all arrays so far.
  size_t used_bytes() const { return used_; }
  /// Bytes to hand to the other constructor for the same layout at any alignment of the memory.
  size_t required_bytes() const {
    if (used_ == 0) return 0;
    return used_ > SIZE_MAX - (kAlignment - 1) ? SIZE_MAX : used_ + kAlignment - 1;
  }
  Span<const ArenaPart> parts() const { return {parts_, part_count_}; }

 private:
  void* take_bytes(size_t count, size_t size);

  unsigned char* memory_ = nullptr;
  size_t capacity_ = 0;
  size_t used_ = 0;
  bool ok_ = true;
  ArenaPart parts_[kMaxParts] = {};
  int32_t part_count_ = 0;
  int32_t part_ = -1;
};

}  // namespace unisim
