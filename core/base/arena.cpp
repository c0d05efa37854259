// SPDX-License-Identifier: MIT
// Bump allocator over the caller's memory.
#include "core/base/arena.hpp"

#include <cstring>

#ifdef UNISIM_ADDRESS_SANITIZER
extern "C" void __asan_poison_memory_region(void const volatile* memory, size_t bytes);
extern "C" void __asan_unpoison_memory_region(void const volatile* memory, size_t bytes);
#endif

namespace unisim {
namespace {

#ifdef UNISIM_ADDRESS_SANITIZER
void poison(const void* memory, size_t bytes) { __asan_poison_memory_region(memory, bytes); }
void unpoison(const void* memory, size_t bytes) { __asan_unpoison_memory_region(memory, bytes); }
#else
void poison(const void*, size_t) {}
void unpoison(const void*, size_t) {}
#endif

}  // namespace

void Arena::give_back(const void* memory, size_t bytes) { unpoison(memory, bytes); }

Arena::Arena(void* memory, size_t bytes) : memory_(static_cast<unsigned char*>(memory)) {
  if (memory_ == nullptr) {
    ok_ = false;
    return;
  }
  unpoison(memory, bytes);
  const size_t misaligned = reinterpret_cast<uintptr_t>(memory) % kAlignment;
  const size_t skip = misaligned == 0 ? 0 : kAlignment - misaligned;
  memory_ += skip < bytes ? skip : bytes;
  capacity_ = skip < bytes ? bytes - skip : 0;
}

Arena& Arena::begin_part(const char* name) {
  for (int32_t i = 0; i < part_count_; ++i) {
    if (std::strcmp(parts_[i].name, name) == 0) {
      part_ = i;
      return *this;
    }
  }
  UNISIM_CHECK(part_count_ < kMaxParts);
  if (part_count_ == kMaxParts) return *this;
  parts_[part_count_] = {name, 0};
  part_ = part_count_++;
  return *this;
}

void* Arena::take_bytes(size_t count, size_t size) {
  size_t bytes = 0;
  size_t padded = 0;
  const size_t start = used_;
  const bool addressable = !__builtin_mul_overflow(count, size, &bytes) &&
                           !__builtin_add_overflow(bytes, kAlignment - 1 + kGap, &padded) &&
                           !__builtin_add_overflow(used_, padded / kAlignment * kAlignment, &used_);
  if (!addressable) {
    used_ = SIZE_MAX;
    ok_ = false;
  }
  if (part_ >= 0) parts_[part_].bytes += used_ - start;
  if (memory_ == nullptr) return nullptr;
  if (used_ > capacity_) ok_ = false;
  if (!ok_) return nullptr;
  poison(memory_ + start + bytes, used_ - start - bytes);
  return memory_ + start;
}

}  // namespace unisim
