// SPDX-License-Identifier: MIT
// A series of any length in a fixed number of items.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace unisim::live::web {

/// Keeps every item until it is full; then every second one goes, and from then on only every
/// second one comes in, and so on: the whole series is there, ever coarser.
template <typename Item>
class ThinnedSeries {
 public:
  /// @param capacity even
  explicit ThinnedSeries(size_t capacity) : capacity_(capacity) { items_.reserve(capacity); }

  /// The next one of the series will be kept: others need not be made.
  bool takes_next() const { return offered_ % step_ == 0; }

  void add(const Item& item) {
    const bool kept = takes_next();
    ++offered_;
    if (!kept) return;
    items_.push_back(item);
    if (items_.size() < capacity_) return;
    for (size_t k = 0; 2 * k < items_.size(); ++k) items_[k] = items_[2 * k];
    items_.resize(items_.size() / 2);
    step_ *= 2;
  }

  /// One that is not wanted.
  void skip() { ++offered_; }

  std::vector<Item>& items() { return items_; }
  const std::vector<Item>& items() const { return items_; }

 private:
  size_t capacity_;
  std::vector<Item> items_;
  uint64_t offered_ = 0;
  uint64_t step_ = 1;
};

}  // namespace unisim::live::web
