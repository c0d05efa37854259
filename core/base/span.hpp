// SPDX-License-Identifier: MIT
// View of a contiguous array that somebody else owns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/check.hpp"

namespace unisim {

/// Pointer and length; copies share the elements.
template <class T>
class Span {
 public:
  constexpr Span() = default;
  constexpr Span(T* data, int32_t size) : data_(data), size_(size) {}
  /// Span<T> to Span<const T>.
  template <class U, class = std::enable_if_t<std::is_same_v<const U, T>>>
  constexpr Span(Span<U> other) : data_(other.data()), size_(other.size()) {}

  constexpr T* data() const { return data_; }
  constexpr int32_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr T* begin() const { return data_; }
  constexpr T* end() const { return data_ + size_; }
  constexpr T& operator[](int32_t i) const {
    UNISIM_CHECK(i >= 0 && i < size_);
    return data_[i];
  }
  constexpr Span subspan(int32_t first, int32_t count) const {
    UNISIM_CHECK(first >= 0 && count >= 0 && first + count <= size_);
    return Span(data_ + first, count);
  }
  constexpr void fill(const std::remove_const_t<T>& value) const {
    for (T& element : *this) element = value;
  }

 private:
  T* data_ = nullptr;
  int32_t size_ = 0;
};

}  // namespace unisim
