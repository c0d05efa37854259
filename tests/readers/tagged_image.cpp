// SPDX-License-Identifier: MIT
// Images that say how they are to be turned, as cameras and phones write them.
#include "tests/readers/tagged_image.hpp"

#include <cstdint>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/catch.hpp"

namespace {

std::string number(uint32_t value, int bytes, bool big_endian) {
  std::string text(static_cast<size_t>(bytes), '\0');
  for (int k = 0; k < bytes; ++k) {
    const int shift = 8 * (big_endian ? bytes - 1 - k : k);
    text[static_cast<size_t>(k)] = static_cast<char>(value >> shift & 0xff);
  }
  return text;
}

std::string big(uint32_t value, int bytes) { return number(value, bytes, true); }
std::string little(uint32_t value, int bytes) { return number(value, bytes, false); }

// One field of a TIFF directory: a 16-bit number.
std::string field(uint32_t tag, uint32_t value, bool big_endian) {
  const auto put = [&](uint32_t x, int bytes) { return number(x, bytes, big_endian); };
  return put(tag, 2) + put(3, 2) + put(1, 4) + put(value, 2) + put(0, 2);
}

// The EXIF block: a TIFF file without pixels.
std::string exif(int orientation, bool big_endian) {
  const auto put = [&](uint32_t x, int bytes) { return number(x, bytes, big_endian); };
  return (big_endian ? "MM" : "II") + put(42, 2) + put(8, 4) + put(1, 2) +
         field(0x112, static_cast<uint32_t>(orientation), big_endian) + put(0, 4);
}

uint32_t crc32(const std::string& bytes) {
  uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<uint8_t>(c);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ (0xedb88320 & (0u - (crc & 1)));
  }
  return ~crc;
}

std::string encoded(const std::string& ending) {
  std::vector<uint8_t> bytes;
  REQUIRE(cv::imencode(ending, corner_image(), bytes));
  return {bytes.begin(), bytes.end()};
}

std::string tagged_jpeg(int orientation) {
  const std::string block = std::string("Exif\0\0", 6) + exif(orientation, true);
  return encoded(".jpg").insert(
      2, "\xff\xe1" + big(static_cast<uint32_t>(block.size()) + 2, 2) + block);
}

std::string tagged_png(int orientation) {
  const std::string chunk = "eXIf" + exif(orientation, false);
  constexpr size_t kAfterHeader = 8 + 25;
  return encoded(".png").insert(
      kAfterHeader, big(static_cast<uint32_t>(chunk.size()) - 4, 4) + chunk + big(crc32(chunk), 4));
}

// A lossless WebP of OpenCV has one chunk of pixels: the extended form says so before it.
std::string tagged_webp(int orientation) {
  const std::string block = exif(orientation, false);
  const std::string size = little(48 - 1, 3) + little(32 - 1, 3);
  const std::string body = "WEBPVP8X" + little(10, 4) + little(8, 4) + size +
                           encoded(".webp").substr(12) + "EXIF" +
                           little(static_cast<uint32_t>(block.size()), 4) + block;
  return "RIFF" + little(static_cast<uint32_t>(body.size()), 4) + body;
}

// Uncompressed gray pixels after a directory of nine fields.
std::string tagged_tiff(int orientation) {
  cv::Mat gray;
  cv::extractChannel(corner_image(), gray, 0);
  constexpr uint32_t kPixels = 8 + 2 + 9 * 12 + 4;
  const uint32_t fields[9][2] = {{0x100, 48}, {0x101, 32}, {0x102, 8},
                                 {0x103, 1},  {0x106, 1},  {0x111, kPixels},
                                 {0x112, 0},  {0x116, 32}, {0x117, 48 * 32}};
  std::string file = "II" + little(42, 2) + little(8, 4) + little(9, 2);
  for (const auto& [tag, value] : fields) {
    file += field(tag, tag == 0x112 ? static_cast<uint32_t>(orientation) : value, false);
  }
  file += little(0, 4);
  return file.append(reinterpret_cast<const char*>(gray.data), gray.total());
}

}  // namespace

cv::Mat corner_image() {
  cv::Mat image(32, 48, CV_8UC3, cv::Scalar::all(20));
  image(cv::Rect(0, 0, 24, 16)).setTo(cv::Scalar::all(220));
  return image;
}

void write_tagged_image(const TempFolder& folder, const std::string& name, int orientation) {
  const std::string ending = name.substr(name.find_last_of('.'));
  if (ending == ".tif") {
    folder.write(name, tagged_tiff(orientation == 0 ? 1 : orientation));
  } else if (orientation == 0) {
    folder.write(name, encoded(ending));
  } else if (ending == ".jpg") {
    folder.write(name, tagged_jpeg(orientation));
  } else if (ending == ".png") {
    folder.write(name, tagged_png(orientation));
  } else {
    folder.write(name, tagged_webp(orientation));
  }
}
