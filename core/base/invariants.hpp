// SPDX-License-Identifier: MIT
// What cannot fail, and whether it has all the same.
#pragma once

#include "core/base/check.hpp"
#include "core/base/status.hpp"

namespace unisim {

/// Whether all calls that cannot fail have not: one for all parts of a session. Once one has, what
/// the session holds is not to be trusted, and every later call says so.
class Invariants {
 public:
  /// `status` comes from a call that cannot fail here. @return whether all has held so far
  bool holds(Status status) {
    if (!is_ok(status)) broken_ = true;
    UNISIM_CHECK(!broken_);
    return !broken_;
  }
  bool broken() const { return broken_; }

 private:
  bool broken_ = false;
};

}  // namespace unisim
