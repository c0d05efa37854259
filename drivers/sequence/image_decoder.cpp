// SPDX-License-Identifier: MIT
// Decodes image files one after the other into the same memory.
#include "drivers/sequence/image_decoder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string_view>

#include "drivers/sequence/folder.hpp"

namespace unisim::sequence {
namespace {

constexpr std::streamoff kMaxFileBytes = 256 << 20;
constexpr size_t kTailBytes = 1024;  // some writers append a few bytes after the end mark

// Decoders fill the missing part of a cut-off JPEG or PNG with gray: the end mark tells.
bool is_truncated(const std::vector<uint8_t>& file) {
  const std::string_view all(reinterpret_cast<const char*>(file.data()), file.size());
  const std::string_view tail = all.substr(all.size() - std::min(all.size(), kTailBytes));
  if (all.substr(0, 2) == "\xFF\xD8") return tail.find("\xFF\xD9") == std::string_view::npos;
  if (all.substr(0, 4) == "\x89PNG") return tail.find("IEND") == std::string_view::npos;
  return false;
}

std::string size_text(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

bool SizeCheck::fits(const cv::Mat& image, std::string* message) {
  if (size_.empty()) size_ = image.size();
  if (image.size() == size_) return true;
  *message = "is " + size_text(image.size()) + " but the sequence began with " + size_text(size_);
  return false;
}

unisim_image view_of(const cv::Mat& image) {
  return {image.data, image.cols, image.rows, static_cast<int32_t>(image.step),
          image.channels() == 1 ? UNISIM_PIXEL_GRAY8 : UNISIM_PIXEL_BGR8};
}

bool ImageDecoder::read_file(const std::string& path, std::string* message) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream || !is_file(path)) {
    *message = std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : ENOENT);
    return false;
  }
  const std::streamoff bytes = stream.tellg();
  if (bytes <= 0 || bytes > kMaxFileBytes) {
    *message = bytes <= 0 ? "is empty" : "is larger than 256 MB";
    return false;
  }
  file_.resize(static_cast<size_t>(bytes));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(file_.data()), bytes);
  if (!stream) *message = "cannot be read to its end";
  return static_cast<bool>(stream);
}

bool ImageDecoder::decode(const std::string& path, unisim_image* image, std::string* message) {
  if (!read_file(path, message)) return false;
  if (is_truncated(file_)) {
    *message = "is truncated";
    return false;
  }
  // Without a decoder for it imdecode() leaves the image before in place: asked for first.
  if (!cv::haveImageReader(path) || !decode_buffer()) {
    *message = "is not an image that can be decoded";
    return false;
  }
  if (!size_.fits(image_, message)) return false;
  *image = view_of(image_);
  return true;
}

bool ImageDecoder::decode_buffer() {
  try {
    return !cv::imdecode(file_, cv::IMREAD_ANYCOLOR, &image_).empty();
  } catch (const cv::Exception&) {
    return false;
  }
}

}  // namespace unisim::sequence
