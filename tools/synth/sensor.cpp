// SPDX-License-Identifier: MIT
// Sensor model.
#include "tools/synth/sensor.hpp"

#include "tools/synth/random.hpp"

namespace unisim::synth {
namespace {

constexpr float kReadNoise = 1.5f;
constexpr float kShotNoiseAtWhite = 3.0f;

/// Sum of four uniform numbers, scaled to zero mean and unit variance: Gaussian enough.
float gaussian(uint64_t bits) {
  const auto sum = static_cast<float>((bits & 0xffff) + ((bits >> 16) & 0xffff) +
                                      ((bits >> 32) & 0xffff) + (bits >> 48));
  return (sum / 65535.0f - 2.0f) * 1.7320508f;
}

uint8_t to_byte(float value) {
  return static_cast<uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
}

}  // namespace

double exposure_gain(const SensorOptions& options, int frame) {
  if (!options.exposure_jumps) {
    return 1;
  }
  Random random(derive_seed(options.seed, 600));
  double gain = 1;
  for (double next = 0; next <= frame; next += random.uniform(0.5, 2.0) * options.fps) {
    gain = random.uniform(0.7, 1.3);
  }
  return gain;
}

cv::Mat expose(const ColorImage& colors, const Camera& camera, float scale,
               const SensorOptions& options, int frame) {
  const float gain = scale * static_cast<float>(exposure_gain(options, frame));
  const uint64_t frame_seed = derive_seed(options.seed, 0x10000u + static_cast<uint64_t>(frame));
  cv::Mat image(camera.height, camera.width, CV_8UC3);
  size_t at = 0;
  for (int row = 0; row < camera.height; ++row) {
    auto* out = image.ptr<cv::Vec3b>(row);
    for (int column = 0; column < camera.width; ++column, ++at) {
      Color color = gain * colors[at];
      if (options.noise) {
        for (int channel = 0; channel < 3; ++channel) {
          const float shot = kShotNoiseAtWhite * kShotNoiseAtWhite * color[channel] / 255.0f;
          const float sigma = std::sqrt(kReadNoise * kReadNoise + std::max(shot, 0.0f));
          color[channel] +=
              sigma * gaussian(hash(frame_seed + 3 * at + static_cast<uint64_t>(channel)));
        }
      }
      out[column] = {to_byte(color[2]), to_byte(color[1]), to_byte(color[0])};
    }
  }
  return image;
}

cv::Mat encode_depth(const DepthImage& depth, const Camera& camera, float factor) {
  cv::Mat image(camera.height, camera.width, CV_16UC1);
  size_t at = 0;
  for (int row = 0; row < camera.height; ++row) {
    auto* out = image.ptr<uint16_t>(row);
    for (int column = 0; column < camera.width; ++column, ++at) {
      const float value = depth[at] * factor + 0.5f;
      out[column] = value < 65536.0f ? static_cast<uint16_t>(value) : uint16_t{0};
    }
  }
  return image;
}

}  // namespace unisim::synth
