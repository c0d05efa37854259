// SPDX-License-Identifier: MIT
// How the images of a sequence become 8-bit pictures: decided once, the same for each of them.
#include "drivers/sequence/pixel_rule.hpp"

#include <algorithm>
#include <cctype>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/image_decoder.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

// A dark first image would tell too few bits: as many are looked at, spread over the sequence.
constexpr size_t kBrightnessSamples = 8;

bool names_depth(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name.find("depth") != std::string::npos;
}

void refuse_depth_map(const std::string& path, const cv::Mat& stored) {
  if (stored.type() != CV_16UC1) return;
  if (!names_depth(base_name(path)) && !names_depth(base_name(parent(path)))) return;
  throw InputError(path +
                   ": a depth map (16 bits, one channel), not a picture: give the colour "
                   "or gray images");
}

int brightest(const cv::Mat& image) {
  double largest = 0;
  cv::minMaxLoc(image.reshape(1), nullptr, &largest);
  return static_cast<int>(largest);
}

}  // namespace

int bits_that_hold(int brightest) {
  int bits = 8;
  while (bits < 16 && brightest >= 1 << bits) bits += 2;
  return bits;
}

cv::Mat upright(const cv::Mat& image, int orientation, cv::Mat* turned) {
  constexpr int kNoFlip = 2;
  // By EXIF number: first rows and columns change places, then one or both are reversed.
  constexpr int kFlips[] = {kNoFlip, kNoFlip, 1, -1, 0, kNoFlip, 1, -1, 0};
  if (orientation <= 1 || orientation > 8) return image;
  const int flip = kFlips[orientation];
  if (orientation < 5) {
    cv::flip(image, *turned, flip);
    return *turned;
  }
  cv::transpose(image, *turned);
  if (flip != kNoFlip) cv::flip(*turned, *turned, flip);
  return *turned;
}

void reduce_to_8_bits(const cv::Mat& deep, int bits, cv::Mat* image) {
  const int shift = bits - 8;
  image->create(deep.size(), CV_8UC(deep.channels()));
  const int count = deep.cols * deep.channels();
  for (int y = 0; y < deep.rows; ++y) {
    const uint16_t* from = deep.ptr<uint16_t>(y);
    uint8_t* to = image->ptr<uint8_t>(y);
    for (int i = 0; i < count; ++i) to[i] = static_cast<uint8_t>(std::min(from[i] >> shift, 255));
  }
}

PixelRule learn_pixel_rule(const std::vector<std::string>& paths) {
  StoredImage image;
  size_t first = 0;
  while (first < paths.size() && !image.read(paths[first])) ++first;
  if (first == paths.size()) return {};
  PixelRule rule;
  rule.orientation = image.orientation();
  if (image.pixels().depth() != CV_16U) return rule;
  refuse_depth_map(paths[first], image.pixels());
  int largest = brightest(image.pixels());
  const size_t count = paths.size() - first;
  for (size_t k = 1; k < kBrightnessSamples; ++k) {
    const bool good = image.read(paths[first + k * (count - 1) / (kBrightnessSamples - 1)]);
    if (good && image.pixels().depth() == CV_16U) {
      largest = std::max(largest, brightest(image.pixels()));
    }
  }
  rule.bits = bits_that_hold(largest);
  return rule;
}

std::string pixel_note(const PixelRule& rule) {
  if (rule.bits == 16) return "";
  return "16-bit images that use " + std::to_string(rule.bits) + " bits: seen in that range";
}

}  // namespace unisim::sequence
