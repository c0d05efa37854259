// SPDX-License-Identifier: MIT
// Where an image file says how its picture is turned: EXIF tag 0x0112, the TIFF field of that name.
#include "drivers/sequence/exif_orientation.hpp"

#include <string_view>

namespace unisim::sequence {
namespace {

using namespace std::string_view_literals;

constexpr auto kExifHead = "Exif\0\0"sv;

/// The bytes of a file; reading beyond their end gives zeros.
class Bytes {
 public:
  explicit Bytes(const std::vector<uint8_t>& file) : file_(file) {}

  size_t size() const { return file_.size(); }

  uint64_t number(size_t at, size_t bytes, bool big_endian) const {
    if (at > size() || bytes > size() - at) return 0;
    uint64_t value = 0;
    for (size_t k = 0; k < bytes; ++k) {
      value = value << 8 | file_[at + (big_endian ? k : bytes - 1 - k)];
    }
    return value;
  }

  bool has(size_t at, std::string_view text) const {
    if (at > size() || text.size() > size() - at) return false;
    return std::string_view(reinterpret_cast<const char*>(file_.data()) + at, text.size()) == text;
  }

 private:
  const std::vector<uint8_t>& file_;
};

using Found = std::optional<OrientationTag>;

/// First directory of the TIFF structure that begins at `start`.
Found in_tiff(const Bytes& file, size_t start) {
  const bool big_endian = file.has(start, "MM\0*"sv);
  if (!big_endian && !file.has(start, "II*\0"sv)) return {};
  const size_t directory = start + static_cast<size_t>(file.number(start + 4, 4, big_endian));
  const uint64_t fields = file.number(directory, 2, big_endian);
  for (uint64_t k = 0; k < fields; ++k) {
    const size_t field = directory + 2 + 12 * static_cast<size_t>(k);
    constexpr uint64_t kOrientation = 0x0112;
    constexpr uint64_t kShort = 3;
    if (file.number(field, 2, big_endian) != kOrientation) continue;
    const uint64_t value = file.number(field + 8, 2, big_endian);
    if (file.number(field + 2, 2, big_endian) != kShort || value < 1 || value > 8) return {};
    return OrientationTag{static_cast<int>(value), field + 8, big_endian};
  }
  return {};
}

/// Segments up to the pixels; the block is in one of kind APP1.
Found in_jpeg(const Bytes& file) {
  constexpr uint64_t kScan = 0xFFDA;
  constexpr uint64_t kApp1 = 0xFFE1;
  for (size_t at = 2; at + 4 <= file.size();) {
    const uint64_t marker = file.number(at, 2, true);
    if (marker < 0xFF00 || marker == kScan) return {};
    if (marker == kApp1 && file.has(at + 4, kExifHead)) {
      return in_tiff(file, at + 4 + kExifHead.size());
    }
    at += 2 + static_cast<size_t>(file.number(at + 2, 2, true));
  }
  return {};
}

Found in_png(const Bytes& file) {
  for (size_t at = 8; at + 12 <= file.size();) {
    if (file.has(at + 4, "eXIf")) return in_tiff(file, at + 8);
    at += 12 + static_cast<size_t>(file.number(at, 4, true));
  }
  return {};
}

Found in_webp(const Bytes& file) {
  for (size_t at = 12; at + 8 <= file.size();) {
    const size_t data = at + 8;
    if (file.has(at, "EXIF")) {
      return in_tiff(file, data + (file.has(data, kExifHead) ? kExifHead.size() : 0));
    }
    const auto bytes = static_cast<size_t>(file.number(at + 4, 4, false));
    at = data + bytes + bytes % 2;
  }
  return {};
}

}  // namespace

std::optional<OrientationTag> find_orientation(const std::vector<uint8_t>& file) {
  const Bytes bytes(file);
  if (bytes.has(0, "\xFF\xD8")) return in_jpeg(bytes);
  if (bytes.has(0, "\x89PNG")) return in_png(bytes);
  if (bytes.has(0, "RIFF") && bytes.has(8, "WEBP")) return in_webp(bytes);
  return in_tiff(bytes, 0);
}

}  // namespace unisim::sequence
