// SPDX-License-Identifier: MIT
// Counts the heap calls made while a thread is inside libunisim: this program's malloc family
// stands before the C library's and passes every call on.
#include "tools/common/heap_counter.hpp"

#include <atomic>
#include <cstddef>

#if defined(__GLIBC__) && !defined(UNISIM_SANITIZED)
#define UNISIM_COUNT_HEAP_CALLS 1
#else
#define UNISIM_COUNT_HEAP_CALLS 0
#endif

#if UNISIM_COUNT_HEAP_CALLS

namespace {

thread_local int depth_inside = 0;
std::atomic<int64_t> calls{0};

void note_call() {
  if (depth_inside > 0) calls.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

extern "C" {
// The C library's own entry points, exported for this purpose: their names are its choice.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

__attribute__((visibility("default"))) void* malloc(size_t size) {
  note_call();
  return __libc_malloc(size);
}

__attribute__((visibility("default"))) void* calloc(size_t count, size_t size) {
  note_call();
  return __libc_calloc(count, size);
}

__attribute__((visibility("default"))) void* realloc(void* block, size_t size) {
  note_call();
  return __libc_realloc(block, size);
}

__attribute__((visibility("default"))) void* memalign(size_t alignment, size_t size) {
  note_call();
  return __libc_memalign(alignment, size);
}

__attribute__((visibility("default"))) void* aligned_alloc(size_t alignment, size_t size) {
  note_call();
  return __libc_memalign(alignment, size);
}

__attribute__((visibility("default"))) int posix_memalign(void** block, size_t alignment,
                                                          size_t size) {
  note_call();
  constexpr int kNoMemory = 12;
  void* const got = __libc_memalign(alignment, size);
  if (got == nullptr) return kNoMemory;
  *block = got;
  return 0;
}
}

namespace unisim::tools {

pipeline::HeapWatch heap_counter() {
  pipeline::HeapWatch watch;
  watch.enter = [] { ++depth_inside; };
  watch.leave = [] { --depth_inside; };
  watch.count = [] { return calls.load(); };
  return watch;
}

}  // namespace unisim::tools

#else

namespace unisim::tools {

pipeline::HeapWatch heap_counter() { return {}; }

}  // namespace unisim::tools

#endif
