// SPDX-License-Identifier: MIT
// Slots of a list that are used again once their element has gone.
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"

namespace unisim {

/// Slot for a new element: a freed one, else one more at the end. The caller has checked room().
template <class T>
int32_t take_slot(FixedVector<T>* items, FixedVector<int32_t>* free_slots) {
  if (!free_slots->empty()) {
    const int32_t slot = free_slots->back();
    free_slots->pop_back();
    return slot;
  }
  items->resize(items->size() + 1);
  return items->size() - 1;
}

template <class T>
int32_t room(const FixedVector<T>& items, const FixedVector<int32_t>& free_slots) {
  return items.capacity() - items.size() + free_slots.size();
}

inline void give_back(FixedVector<int32_t>* free_slots, int32_t slot) {
  const bool stored = free_slots->push_back(slot);
  UNISIM_CHECK(stored);
  static_cast<void>(stored);
}

}  // namespace unisim
