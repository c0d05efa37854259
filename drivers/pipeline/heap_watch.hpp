// SPDX-License-Identifier: MIT
// Hook by which a program counts the heap calls made inside libunisim.
#pragma once

#include <cstdint>

namespace unisim::pipeline {

/// Functions of a program that intercepts the allocator; all NULL: nothing is counted.
/// Counting is per thread, between enter() and leave().
struct HeapWatch {
  void (*enter)() = nullptr;
  void (*leave)() = nullptr;
  int64_t (*count)() = nullptr;  ///< calls so far, of all threads

  /// Calls so far, 0 where nothing is counted.
  int64_t calls() const { return count != nullptr ? count() : 0; }
};

/// Marks one stay inside the library.
class InsideLibrary {
 public:
  explicit InsideLibrary(const HeapWatch& watch) : watch_(watch) {
    if (watch_.enter != nullptr) watch_.enter();
  }
  ~InsideLibrary() {
    if (watch_.leave != nullptr) watch_.leave();
  }
  InsideLibrary(const InsideLibrary&) = delete;
  InsideLibrary& operator=(const InsideLibrary&) = delete;

 private:
  const HeapWatch& watch_;
};

}  // namespace unisim::pipeline
