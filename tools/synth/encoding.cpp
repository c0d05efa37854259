// SPDX-License-Identifier: MIT
// Frames that carry their own truth.
#include "tools/synth/encoding.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::synth {
namespace {

constexpr double kMaxNumber = (1 << 24) - 1;
constexpr double kRotationStep = 0x1p-22;     // of -2 .. 2
constexpr double kTranslationStep = 0x1p-18;  // metres, of -32 .. 32
constexpr double kDepthStep = 0x1p-20;        // metres, up to 16
constexpr double kFocalStep = 0x1p-10;        // pixels
constexpr double kShareStep = 0x1p-24;

cv::Vec3b pixel_of(double value, double step, double offset) {
  const double whole = std::round((value - offset) / step);
  const auto number = static_cast<uint32_t>(std::clamp(whole, 0.0, kMaxNumber));
  return {static_cast<uint8_t>(number), static_cast<uint8_t>(number >> 8),
          static_cast<uint8_t>(number >> 16)};
}

void write_header(const Camera& camera, const EncodedHeader& header, cv::Vec3b* out) {
  for (int i = 0; i < 9; ++i) {
    *out++ = pixel_of(header.T_world_cam.linear()(i / 3, i % 3), kRotationStep, -2);
  }
  for (int i = 0; i < 3; ++i) {
    *out++ = pixel_of(header.T_world_cam.translation()[i], kTranslationStep, -32);
  }
  *out++ = pixel_of(camera.focal_px, kFocalStep, 0);
  *out++ = pixel_of(header.share, kShareStep, 0);
  *out++ = pixel_of(header.spread, kShareStep, 0);
}

}  // namespace

cv::Mat encode_frame(const DepthImage& depth, const Camera& camera, const EncodedHeader& header) {
  cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar::all(0));
  write_header(camera, header, image.ptr<cv::Vec3b>(0));
  for (int row = 1; row < camera.height; ++row) {
    const float* from = depth.data() + static_cast<ptrdiff_t>(row) * camera.width;
    auto* out = image.ptr<cv::Vec3b>(row);
    for (int column = 0; column < camera.width; ++column) {
      // Nothing seen is as far as can be said: a model has no word for it.
      const double z = from[column] > 0 ? double{from[column]} : kMaxNumber * kDepthStep;
      out[column] = pixel_of(std::max(z, kDepthStep), kDepthStep, 0);
    }
  }
  return image;
}

}  // namespace unisim::synth
