// SPDX-License-Identifier: MIT
// The edge between exceptions and the C API where something is created.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

namespace unisim::drivers {

/// What `make` returns, a pointer; nullptr when it throws, and why.
/// @tparam Error     the driver's own exception, with problem(); its line names the driver
/// @param  prefix    before the line of any other exception
/// @param  otherwise problem of any other exception
/// @param[out] problem 0 where all is well; may be nullptr, as `message` may
/// @param[out] message one line, cut to `capacity` bytes
template <class Error, class Make>
auto create(const char* prefix, int32_t otherwise, int32_t* problem, char* message, size_t capacity,
            Make make) -> decltype(make()) {
  int32_t kind = 0;
  std::string line;
  decltype(make()) made = nullptr;
  try {
    made = make();
  } catch (const Error& error) {
    kind = error.problem();
    line = error.what();
  } catch (const std::exception& error) {
    kind = otherwise;
    line = std::string(prefix) + error.what();
  }
  if (problem != nullptr) *problem = kind;
  if (made == nullptr && message != nullptr && capacity > 0) {
    std::snprintf(message, capacity, "%s", line.c_str());
  }
  return made;
}

}  // namespace unisim::drivers
