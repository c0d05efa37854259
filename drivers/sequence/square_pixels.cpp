// SPDX-License-Identifier: MIT
// Videos whose pixels are wider than high, or the other way, become pictures of square ones.
#include "drivers/sequence/square_pixels.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/common/size_text.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

// Stretches a picture of 1000 pixels by less than one: a rounding of encoders, below what a focal
// length is known to.
constexpr double kNearlySquare = 1e-3;
// Anamorphic film has 2:1.
constexpr double kLargestAspect = 8.0;

int whole(double pixels) { return static_cast<int>(std::lround(pixels)); }

}  // namespace

SquarePixels::SquarePixels(cv::Size stored, cv::Size shown, const std::string& aspect)
    : shown_(shown),
      notes_{"pixels are " + aspect + ", not square: the pictures are stretched from " +
             drivers::size_text(stored.width, stored.height) + " to " +
             drivers::size_text(shown.width, shown.height) +
             ", and a focal length in pixels is of these"} {}

const cv::Mat& SquarePixels::apply(const cv::Mat& image, cv::Mat* stretched) const {
  if (shown_.empty()) return image;
  const bool smaller = shown_.area() < image.size().area();
  cv::resize(image, *stretched, shown_, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
  return *stretched;
}

SquarePixels square_pixels(const std::string& path, const cv::VideoCapture& video) {
  const double across = video.get(cv::CAP_PROP_SAR_NUM);
  const double down = video.get(cv::CAP_PROP_SAR_DEN);
  if (!(across > 0 && down > 0) || std::abs(across / down - 1) < kNearlySquare) return {};
  const std::string aspect = std::to_string(whole(across)) + ":" + std::to_string(whole(down));
  if (across > kLargestAspect * down || down > kLargestAspect * across) {
    throw InputError(path + ": says that its pixels are " + aspect +
                     ": write what is true with ffmpeg -i FILE -aspect 16:9 -c copy NEW.mp4");
  }
  // OpenCV turns the pictures of a camera that was held upright; the aspect is of those stored.
  const int turn = static_cast<int>(video.get(cv::CAP_PROP_ORIENTATION_META));
  const bool turned = video.get(cv::CAP_PROP_ORIENTATION_AUTO) != 0 && turn % 180 != 0;
  const cv::Size size(static_cast<int>(video.get(cv::CAP_PROP_FRAME_WIDTH)),
                      static_cast<int>(video.get(cv::CAP_PROP_FRAME_HEIGHT)));
  cv::Size shown = size;
  (turned ? shown.height : shown.width) =
      whole((turned ? size.height : size.width) * across / down);
  return {size, shown, aspect};
}

}  // namespace unisim::sequence
