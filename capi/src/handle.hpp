// SPDX-License-Identifier: MIT
// The session behind a handle of unisim.h.
#pragma once

#include "core/session.hpp"
#include "unisim/unisim.h"

namespace unisim {

inline Session* core(unisim_session* session) { return reinterpret_cast<Session*>(session); }
inline const Session* core(const unisim_session* session) {
  return reinterpret_cast<const Session*>(session);
}

/// False for NULL, and for what was destroyed while its arena has not been used for anything else.
inline bool is_live(const unisim_session* session) {
  return session != nullptr && core(session)->live();
}

/// What every call but reset and destroy asks first.
inline unisim_status check_session(const unisim_session* session) {
  if (!is_live(session)) return UNISIM_ERR_INVALID_ARGUMENT;
  return core(session)->broken() ? UNISIM_ERR_INTERNAL : UNISIM_OK;
}

}  // namespace unisim
