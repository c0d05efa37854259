// SPDX-License-Identifier: MIT
// Predictions to and from the data part of a record, every float bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/predictor.h"
#include "drivers/recorded/record_reader.hpp"
#include "drivers/recorded/record_writer.hpp"

namespace unisim::recorded {

void encode_pair(const unisim_pair_prediction& pair, RecordBytes* out);
void encode_window(const unisim_window_prediction& window, RecordBytes* out);
void encode_place(const unisim_place_descriptor& place, RecordBytes* out);
void encode_revision(const unisim_window_revision& revision, RecordBytes* out);

/// What a decoded prediction points into; kept by the caller as long as the prediction.
struct DecodedArrays {
  AlignedBytes data;
  std::vector<unisim_depth_map> depth;
};

/// How decoding ended.
enum class Decoded {
  kOk,
  kNotFinite,  ///< a pose, sigma, focal length or confidence is not a number
  kMalformed   ///< sizes that contradict each other
};

/// Each reads `size` bytes of arrays->data; the result points into *arrays.
/// `problem` gets a few words unless kOk.
Decoded decode_pair(std::size_t size, DecodedArrays* arrays, unisim_pair_prediction* out,
                    std::string* problem);
Decoded decode_window(std::size_t size, DecodedArrays* arrays, unisim_window_prediction* out,
                      std::string* problem);
Decoded decode_revision(std::size_t size, DecodedArrays* arrays, unisim_window_revision* out,
                        std::string* problem);

/// No number of a place can be wrong by itself.
Decoded decode_place(std::size_t size, DecodedArrays* arrays, unisim_place_descriptor* out,
                     std::string* problem);

/// A single pose of `size` bytes.
Decoded decode_pose(std::size_t size, const AlignedBytes& data, unisim_sim3* out);

}  // namespace unisim::recorded
