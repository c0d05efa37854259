// SPDX-License-Identifier: MIT
// What the processor can do beyond what the build takes for granted.
#pragma once

namespace unisim {

/// 256-bit vectors, in the processor and in the system that runs on it.
bool cpu_has_avx2();

/// 512-bit vectors too, on a processor that does not slow down for them.
bool cpu_has_avx512();

}  // namespace unisim
