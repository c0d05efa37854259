// SPDX-License-Identifier: MIT
// Whether two sessions say the same, to the last bit.
#pragma once

#include <cstring>

#include "tests/support/catch.hpp"
#include "unisim/unisim.h"

namespace unisim::test {

/// Poses of keyframes 0 .. keyframes - 1, or why there is none.
inline bool same_poses(const unisim_session* a, const unisim_session* b, int32_t keyframes) {
  bool same = true;
  for (int32_t id = 0; id < keyframes; ++id) {
    unisim_pose p = {};
    unisim_pose q = {};
    p.struct_size = q.struct_size = sizeof p;
    const unisim_status status = unisim_get_pose(a, id, &p);
    same = same && unisim_get_pose(b, id, &q) == status && std::memcmp(&p, &q, sizeof p) == 0;
  }
  return same;
}

inline bool same_info(const unisim_session* a, const unisim_session* b) {
  unisim_session_info p = {};
  unisim_session_info q = {};
  p.struct_size = q.struct_size = sizeof p;
  REQUIRE(unisim_get_info(a, &p) == UNISIM_OK);
  REQUIRE(unisim_get_info(b, &q) == UNISIM_OK);
  return std::memcmp(&p, &q, sizeof p) == 0;
}

}  // namespace unisim::test
