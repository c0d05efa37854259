// SPDX-License-Identifier: MIT
// Sources that are compiled once per instruction set, and the choice between them at run time.
#pragma once

// A vectorised source (cmake: unisim_vectorised_sources) puts all it defines into the namespace
// UNISIM_ISA. It may not use Eigen, templates of the standard library or inline functions that
// other files define too: the linker keeps one copy of those, maybe one that an old processor
// cannot run. Both copies make the same operations in the same order, so the results are the same
// bits.
#ifndef UNISIM_ISA
#define UNISIM_ISA baseline
#endif

#ifdef UNISIM_ONE_ISA
/// There is one copy of each source: the compiler weighs size and speed.
#define UNISIM_ALWAYS_INLINE inline
#else
/// Inlined even without optimisation: leaves no symbol behind.
#define UNISIM_ALWAYS_INLINE inline __attribute__((always_inline))
#endif

// UNISIM_EACH_ISA(declarations): declares the functions of a vectorised source, every copy of them.
// UNISIM_DISPATCH(call): calls one of these functions, the copy for this processor.
// UNISIM_EACH_WIDE_ISA, UNISIM_DISPATCH_WIDE: the same where one more copy is for AVX-512.
#define UNISIM_EACH_ISA(...) UNISIM_IN_BASELINE(__VA_ARGS__) UNISIM_IN_AVX2(__VA_ARGS__)
#define UNISIM_EACH_WIDE_ISA(...) UNISIM_EACH_ISA(__VA_ARGS__) UNISIM_IN_AVX512(__VA_ARGS__)
#define UNISIM_IN_BASELINE(...) \
  namespace baseline {          \
  __VA_ARGS__                   \
  }
#ifdef UNISIM_HAS_WIDE_VECTORS
#include "core/base/cpu.hpp"
#define UNISIM_IN_AVX2(...) \
  namespace avx2 {          \
  __VA_ARGS__               \
  }
#define UNISIM_IN_AVX512(...) \
  namespace avx512 {          \
  __VA_ARGS__                 \
  }
#define UNISIM_DISPATCH(call) (cpu_has_avx2() ? avx2::call : baseline::call)
#define UNISIM_DISPATCH_WIDE(call) (cpu_has_avx512() ? avx512::call : UNISIM_DISPATCH(call))
#else
#define UNISIM_IN_AVX2(...)
#define UNISIM_IN_AVX512(...)
#define UNISIM_DISPATCH(call) (baseline::call)
#define UNISIM_DISPATCH_WIDE(call) UNISIM_DISPATCH(call)
#endif
