// SPDX-License-Identifier: MIT
// Images of keyframes that may be seen again.
#include "drivers/onnx/predict/place_images.hpp"

#include <opencv2/imgcodecs.hpp>

#include "drivers/common/image_mat.hpp"

namespace unisim::onnx {
namespace {

// The fastest level: the next ones take twice the time for a tenth less.
const std::vector<int> kFast = {cv::IMWRITE_PNG_COMPRESSION, 1};

}  // namespace

void PlaceImages::add(int32_t id, const unisim_image& image) {
  std::vector<uint8_t> file;
  cv::imencode(".png", drivers::image_mat(image), file, kFast);
  file.shrink_to_fit();
  const std::lock_guard<std::mutex> lock(mutex_);
  bytes_ += static_cast<int64_t>(file.size());
  files_[id] = std::move(file);
}

void PlaceImages::release(int32_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = files_.find(id);
  if (found == files_.end()) return;
  bytes_ -= static_cast<int64_t>(found->second.size());
  files_.erase(found);
}

unisim_image PlaceImages::find(int32_t id, std::vector<uint8_t>* pixels) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = files_.find(id);
  if (found == files_.end()) return {};
  const cv::Mat image = cv::imdecode(found->second, cv::IMREAD_UNCHANGED);
  const size_t size = image.total() * image.elemSize();
  pixels->assign(image.data, image.data + size);
  return {pixels->data(), image.cols, image.rows,
          static_cast<int32_t>(image.cols * image.channels()),
          image.channels() == 1 ? UNISIM_PIXEL_GRAY8 : UNISIM_PIXEL_BGR8};
}

int64_t PlaceImages::bytes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return bytes_;
}

}  // namespace unisim::onnx
