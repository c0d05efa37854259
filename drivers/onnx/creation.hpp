// SPDX-License-Identifier: MIT
// The edge between exceptions and the C API where something is created.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "drivers/onnx/error.hpp"

namespace unisim::onnx {

/// What `make` returns, a pointer; nullptr when it throws, and why.
/// @param[out] problem UNISIM_ONNX_*; may be nullptr, as `message` may
/// @param[out] message one line, cut to `capacity` bytes
template <class Make>
auto create(int32_t* problem, char* message, size_t capacity, Make make) -> decltype(make()) {
  int32_t kind = UNISIM_ONNX_OK;
  std::string line;
  decltype(make()) made = nullptr;
  try {
    made = make();
  } catch (const OnnxError& error) {
    kind = error.problem();
    line = error.what();
  } catch (const std::exception& error) {
    kind = UNISIM_ONNX_NO_MEMORY;
    line = std::string("onnx: ") + error.what();
  }
  if (problem != nullptr) *problem = kind;
  if (made == nullptr && message != nullptr && capacity > 0) {
    std::snprintf(message, capacity, "%s", line.c_str());
  }
  return made;
}

}  // namespace unisim::onnx
