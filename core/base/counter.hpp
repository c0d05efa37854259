// SPDX-License-Identifier: MIT
// A counter that nothing bounds.
#pragma once

#include <cstdint>
#include <limits>

namespace unisim {

/// Counts up and stays at the largest number: a session that runs for ever must not wrap.
class Counter {
 public:
  Counter() = default;
  explicit Counter(int32_t value) : value_(value) {}

  void operator++() {
    if (value_ < std::numeric_limits<int32_t>::max()) ++value_;
  }
  operator int32_t() const { return value_; }

  /// Save or load.
  template <class Archive>
  void visit(Archive* archive) {
    archive->index(&value_, 0, std::numeric_limits<int32_t>::max());
  }

 private:
  int32_t value_ = 0;
};

}  // namespace unisim
