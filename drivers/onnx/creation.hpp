// SPDX-License-Identifier: MIT
// The edge between exceptions and the C API where something is created.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drivers/common/creation.hpp"
#include "drivers/onnx/error.hpp"

namespace unisim::onnx {

/// drivers::create() with the problems of this driver.
template <class Make>
auto create(int32_t* problem, char* message, size_t capacity, Make make) -> decltype(make()) {
  return drivers::create<OnnxError>("onnx: ", UNISIM_ONNX_NO_MEMORY, problem, message, capacity,
                                    make);
}

}  // namespace unisim::onnx
