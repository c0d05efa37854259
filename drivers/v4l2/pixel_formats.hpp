// SPDX-License-Identifier: MIT
// The formats this driver reads, and their gray pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace unisim::v4l2 {

/// FourCCs, the cheapest to read first. MJPG only where a decoder is built in.
const std::vector<uint32_t>& usable_formats();
/// "GREY, NV12, ..."
std::string usable_formats_text();

/// Bytes of one row of the first plane of an uncompressed format, 0 for MJPG.
int32_t row_bytes(uint32_t fourcc, int32_t width);

/// Bytes that an image of an uncompressed format takes at least, 0 for MJPG: what follows the gray
/// pixels is not looked at and may be missing.
size_t needed_bytes(uint32_t fourcc, int32_t width, int32_t height, int32_t stride);

/// The gray half of YUYV pixels.
/// @param luma width x height bytes without gaps
void extract_yuyv_luma(const uint8_t* yuyv, int32_t width, int32_t height, int32_t stride,
                       uint8_t* luma);

}  // namespace unisim::v4l2
