// SPDX-License-Identifier: MIT
// Checks of invariants in debug builds.
#pragma once

/// Stop a build without NDEBUG where an invariant of the library itself is broken; nothing in
/// release.
/// Bad input from outside is answered with a Status, never with this.
#ifdef NDEBUG
#define UNISIM_CHECK(condition) static_cast<void>(0)
#else
#define UNISIM_CHECK(condition) ((condition) ? static_cast<void>(0) : __builtin_trap())
#endif
