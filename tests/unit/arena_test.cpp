// SPDX-License-Identifier: MIT
// Arena: counting and carving by the same code.
#include "core/base/arena.hpp"

#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/support/catch.hpp"

using unisim::Arena;
using unisim::Span;

namespace {

struct Layout {
  explicit Layout(Arena& arena) {
    arena.begin_part("bytes");
    bytes = arena.take<unsigned char>(3);
    arena.begin_part("numbers");
    numbers = arena.take<double>(9);
    arena.begin_part("bytes");
    more = arena.take<unsigned char>(65);
  }
  Span<unsigned char> bytes;
  Span<double> numbers;
  Span<unsigned char> more;
};

}  // namespace

TEST_CASE("a dry arena counts padded bytes and hands out no memory") {
  Arena dry;
  const Layout layout(dry);
  CHECK(dry.used_bytes() == 64 + 128 + 128 + 3 * Arena::kGap);
  CHECK(dry.required_bytes() == dry.used_bytes() + 63);
  CHECK(layout.numbers.data() == nullptr);
  CHECK(layout.numbers.size() == 9);
  CHECK(dry.ok());
}

TEST_CASE("an empty layout needs nothing") { CHECK(Arena().required_bytes() == 0); }

TEST_CASE("bytes are listed by part, a repeated name goes on counting") {
  Arena dry;
  const Layout layout(dry);
  REQUIRE(dry.parts().size() == 2);
  CHECK(std::strcmp(dry.parts()[0].name, "bytes") == 0);
  CHECK(dry.parts()[0].bytes == 64 + 128 + 2 * Arena::kGap);
  CHECK(std::strcmp(dry.parts()[1].name, "numbers") == 0);
  CHECK(dry.parts()[1].bytes == 128 + Arena::kGap);
}

TEST_CASE("the counted bytes suffice at every alignment of the memory") {
  Arena dry;
  const Layout counted(dry);
  std::vector<unsigned char> memory(dry.required_bytes() + 64);
  for (size_t shift = 0; shift < 64; ++shift) {
    Arena arena(memory.data() + shift, dry.required_bytes());
    const Layout layout(arena);
    REQUIRE(arena.ok());
    CHECK(reinterpret_cast<uintptr_t>(layout.bytes.data()) % 64 == 0);
    CHECK(reinterpret_cast<uintptr_t>(layout.numbers.data()) % 64 == 0);
    CHECK(layout.more.end() <= memory.data() + shift + dry.required_bytes());
  }
}

TEST_CASE("one byte short of the padded layout is out of memory") {
  Arena dry;
  const Layout counted(dry);
  std::vector<unsigned char> memory(dry.required_bytes() + 64);
  const size_t misaligned = reinterpret_cast<uintptr_t>(memory.data()) % 64;
  unsigned char* aligned = memory.data() + (64 - misaligned) % 64;
  Arena enough(aligned, dry.used_bytes());
  const Layout fits(enough);
  CHECK(enough.ok());
  Arena tight(aligned, dry.used_bytes() - 1);
  const Layout too_large(tight);
  CHECK_FALSE(tight.ok());
  CHECK(too_large.more.data() == nullptr);
}

TEST_CASE("a layout beyond what can be addressed is not ok, however often it wraps") {
  // As on a 32-bit machine, where a legal configuration gets there.
  struct Terabyte {
    unsigned char bytes[size_t{1} << 40];
  };
  const volatile int32_t quarter = 1 << 22;  // of what 64 bits can count
  const volatile int32_t most = std::numeric_limits<int32_t>::max();
  Arena product;
  CHECK(product.take<Terabyte>(quarter).size() == quarter);
  CHECK(product.ok());
  CHECK(product.take<Terabyte>(most).data() == nullptr);
  CHECK_FALSE(product.ok());
  CHECK(product.used_bytes() == SIZE_MAX);
  CHECK(product.required_bytes() == SIZE_MAX);

  Arena sum;
  for (int k = 0; k < 4; ++k) static_cast<void>(sum.take<Terabyte>(quarter));
  static_cast<void>(sum.take<unsigned char>(1));
  CHECK_FALSE(sum.ok());
  CHECK(sum.required_bytes() == SIZE_MAX);

  unsigned char memory[256];
  Arena small(memory, sizeof memory);
  CHECK(small.take<Terabyte>(most).data() == nullptr);
  CHECK(small.take<unsigned char>(1).data() == nullptr);
  CHECK_FALSE(small.ok());
}

TEST_CASE("elements start at their default value whatever the memory held") {
  std::vector<unsigned char> memory(1024, 0xff);
  Arena arena(memory.data(), memory.size());
  for (const double value : arena.take<double>(16)) CHECK(value == 0.0);
}

#ifdef UNISIM_ADDRESS_SANITIZER
extern "C" int __asan_address_is_poisoned(void const volatile* address);

TEST_CASE("the sanitizer sees what lies behind an array, until the memory is given back") {
  std::vector<unsigned char> memory(1024);
  Arena arena(memory.data(), memory.size());
  const Span<unsigned char> first = arena.take<unsigned char>(3);
  const Span<unsigned char> second = arena.take<unsigned char>(8);
  CHECK_FALSE(__asan_address_is_poisoned(first.data() + 2));
  CHECK(__asan_address_is_poisoned(first.data() + 3));
  CHECK(__asan_address_is_poisoned(second.data() - 1));
  CHECK(__asan_address_is_poisoned(second.data() + 8));
  Arena::give_back(memory.data(), memory.size());
  CHECK_FALSE(__asan_address_is_poisoned(first.data() + 3));
}
#endif

TEST_CASE("no memory at all is not ok") {
  Arena arena(nullptr, 100);
  CHECK_FALSE(arena.ok());
}
