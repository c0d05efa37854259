// SPDX-License-Identifier: MIT
// What the processor can do beyond what the build takes for granted.
#include "core/base/cpu.hpp"

namespace unisim {

#if defined(__x86_64__) || defined(__i386__)
bool cpu_has_avx2() { return __builtin_cpu_supports("avx2") != 0; }
// The first processors with AVX-512 lower their clock for it; VBMI2 came with those that do not.
bool cpu_has_avx512() {
  return __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vbmi2") != 0;
}
#else
bool cpu_has_avx2() { return false; }
bool cpu_has_avx512() { return false; }
#endif

}  // namespace unisim
