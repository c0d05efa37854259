// SPDX-License-Identifier: MIT
// A session with its arena.
#pragma once

#include <memory>

#include "tests/support/catch.hpp"
#include "unisim/unisim.h"

namespace unisim::test {

struct OwnedSession {
  explicit OwnedSession(const unisim_config& config) {
    size_t size = 0;
    REQUIRE(unisim_arena_size(&config, &size) == UNISIM_OK);
    arena.reset(new unsigned char[size]);
    REQUIRE(unisim_session_create(&session, &config, arena.get(), size) == UNISIM_OK);
  }
  ~OwnedSession() { unisim_session_destroy(session); }
  OwnedSession(const OwnedSession&) = delete;
  OwnedSession& operator=(const OwnedSession&) = delete;

  std::unique_ptr<unsigned char[]> arena;
  unisim_session* session = nullptr;
};

}  // namespace unisim::test
