// SPDX-License-Identifier: MIT
// Decodes image files one after the other into the same memory.
#include "drivers/sequence/image_decoder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string_view>

#include "drivers/common/size_text.hpp"
#include "drivers/sequence/exif_orientation.hpp"
#include "drivers/sequence/folder.hpp"

namespace unisim::sequence {
namespace {

constexpr std::streamoff kMaxFileBytes = 256 << 20;
constexpr size_t kTailBytes = 1024;  // some writers append a few bytes after the end mark

// The orientation a file names. TIFF decoders turn by themselves: they are told there is nothing to
// do.
int take_orientation(std::vector<uint8_t>* file) {
  const std::optional<OrientationTag> tag = find_orientation(*file);
  if (!tag) return 1;
  const bool tiff = file->front() == 'I' || file->front() == 'M';
  if (!tiff) return tag->value;
  (*file)[tag->at] = tag->big_endian ? 0 : 1;
  (*file)[tag->at + 1] = tag->big_endian ? 1 : 0;
  return tag->value;
}

}  // namespace

// The end mark tells.
bool is_truncated(const std::vector<uint8_t>& file) {
  const std::string_view all(reinterpret_cast<const char*>(file.data()), file.size());
  const std::string_view tail = all.substr(all.size() - std::min(all.size(), kTailBytes));
  if (all.substr(0, 2) == "\xFF\xD8") return tail.find("\xFF\xD9") == std::string_view::npos;
  if (all.substr(0, 4) == "\x89PNG") return tail.find("IEND") == std::string_view::npos;
  return false;
}

bool SizeCheck::fits(const cv::Mat& image, std::string* message) {
  if (size_.empty()) size_ = image.size();
  if (image.size() == size_) return true;
  *message = "is " + drivers::size_text(image.cols, image.rows) + " but the sequence began with " +
             drivers::size_text(size_.width, size_.height);
  return false;
}

unisim_image view_of(const cv::Mat& image) {
  return {image.data, image.cols, image.rows, static_cast<int32_t>(image.step),
          image.channels() == 1 ? UNISIM_PIXEL_GRAY8 : UNISIM_PIXEL_BGR8};
}

bool StoredImage::load(const std::string& path, std::string* message) {
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

bool StoredImage::decode(const std::string& path, int flags, std::string* message) {
  std::string ignored;
  if (message == nullptr) message = &ignored;
  if (!load(path, message)) return false;
  if (is_truncated(file_)) {
    *message = "is truncated";
    return false;
  }
  orientation_ = take_orientation(&file_);
  // Without a decoder for it imdecode() leaves the image before in place: asked for first.
  bool good = cv::haveImageReader(path);
  try {
    good = good && !cv::imdecode(file_, flags | cv::IMREAD_IGNORE_ORIENTATION, &pixels_).empty();
  } catch (const cv::Exception&) {
    good = false;
  }
  if (!good) *message = "is not an image that can be decoded";
  return good;
}

bool StoredImage::read_8_bits(const std::string& path, std::string* message) {
  return decode(path, cv::IMREAD_ANYCOLOR, message);
}

bool StoredImage::read(const std::string& path, std::string* message) {
  // Asked for all bits, OpenCV also gives pixels of 32, which it cannot reduce to 8.
  return decode(path, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH, message) &&
         pixels_.depth() <= CV_16U;
}

bool ImageDecoder::decode(const std::string& path, unisim_image* image, std::string* message) {
  const bool whole = rule_.bits == 16;
  if (!(whole ? stored_.read_8_bits(path, message) : stored_.read(path, message))) return false;
  cv::Mat picture = stored_.pixels();
  if (picture.depth() == CV_16U) {
    reduce_to_8_bits(picture, rule_.bits, &reduced_);
    picture = reduced_;
  }
  picture = upright(picture, rule_.orientation, &turned_);
  if (!size_.fits(picture, message)) return false;
  *image = view_of(picture);
  return true;
}

}  // namespace unisim::sequence
