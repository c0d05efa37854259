// SPDX-License-Identifier: MIT
// Images of keyframes that may be seen again: compressed without loss, as long as they are wanted.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "drivers/image.h"

namespace unisim::onnx {

/// One thread adds while another takes and releases. The caller bounds their number.
class PlaceImages {
 public:
  void add(int32_t id, const unisim_image& image);
  void release(int32_t id);
  /// @param[out] pixels memory of the image
  /// @return data NULL: not kept
  unisim_image find(int32_t id, std::vector<uint8_t>* pixels) const;
  int64_t bytes() const;

 private:
  mutable std::mutex mutex_;
  std::map<int32_t, std::vector<uint8_t>> files_;  // PNG
  int64_t bytes_ = 0;
};

}  // namespace unisim::onnx
