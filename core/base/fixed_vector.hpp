// SPDX-License-Identifier: MIT
// Vector whose capacity comes from an arena and never grows.
#pragma once

#include <cstdint>

#include "core/base/arena.hpp"
#include "core/base/span.hpp"

namespace unisim {

/// Elements 0..size()-1 of an array carved from an arena. Copies share the elements.
template <class T>
class FixedVector {
 public:
  FixedVector() = default;
  FixedVector(Arena& arena, int32_t capacity) : storage_(arena.take<T>(capacity)) {}

  int32_t size() const { return size_; }
  int32_t capacity() const { return storage_.size(); }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == storage_.size(); }

  /// Append; false and no change when full.
  [[nodiscard]] bool push_back(const T& value) {
    if (full()) return false;
    storage_.data()[size_++] = value;
    return true;
  }
  void pop_back() {
    UNISIM_CHECK(size_ > 0);
    --size_;
  }
  void clear() { size_ = 0; }
  /// Elements from the old size on keep what the storage held.
  void resize(int32_t size) {
    UNISIM_CHECK(size >= 0 && size <= capacity());
    size_ = size;
  }

  T* data() { return storage_.data(); }
  const T* data() const { return storage_.data(); }
  T* begin() { return storage_.data(); }
  T* end() { return storage_.data() + size_; }
  const T* begin() const { return storage_.data(); }
  const T* end() const { return storage_.data() + size_; }
  T& operator[](int32_t i) {
    UNISIM_CHECK(i >= 0 && i < size_);
    return storage_.data()[i];
  }
  const T& operator[](int32_t i) const {
    UNISIM_CHECK(i >= 0 && i < size_);
    return storage_.data()[i];
  }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }
  Span<T> span() { return {storage_.data(), size_}; }
  Span<const T> span() const { return {storage_.data(), size_}; }

 private:
  Span<T> storage_;
  int32_t size_ = 0;
};

}  // namespace unisim
