// SPDX-License-Identifier: MIT
// Result codes of core calls.
#pragma once

#include <cstdint>

namespace unisim {

/// Result of a call. The numbers are those of unisim.h and never move; capi asserts that they
/// agree.
enum class [[nodiscard]] Status : int32_t {
  kOk = 0,
  kInvalidArgument = 1,  ///< non-finite number, unknown id: the caller's mistake
  kCapacity = 2,         ///< a declared capacity is too small
  kOutOfMemory = 3,      ///< the arena is too small
  kNotReady = 4,         ///< nothing to do or to give yet
  kNumerical = 5,        ///< no descent or not positive definite
  kInternal = 6,         ///< broken invariant
  kAbiMismatch = 7,      ///< struct_size unknown (capi only)
  kRetired = 8,          ///< it was there, and has made room for newer ones
  kIo = 9,               ///< the caller's stream failed or ended
  kData = 10,            ///< the caller's stream is not what it should be
};

constexpr bool is_ok(Status status) { return status == Status::kOk; }

}  // namespace unisim
