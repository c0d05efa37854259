// SPDX-License-Identifier: MIT
// Agreement with a camera on format, size and rate.
#include "drivers/v4l2/negotiate.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "drivers/common/size_text.hpp"
#include "drivers/v4l2/enumerate.hpp"
#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/pixel_formats.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {
namespace {

// Rates are fractions on both sides: 30000/1001 is meant by 30.
constexpr double kSameRate = 0.01;

struct Candidate {
  uint32_t fourcc;
  int32_t width;
  int32_t height;
  double fps;      // highest rate; 0: not said
  int preference;  // position among the usable formats
};

int32_t nearest_step(int32_t wish, int32_t low, int32_t high, int32_t step) {
  const int32_t inside = std::clamp(wish, low, high);
  return std::min(low + (inside - low + step / 2) / step * step, high);
}

int64_t size_error(const Wish& wish, int32_t width, int32_t height) {
  return std::abs(int64_t{width} - wish.width) + std::abs(int64_t{height} - wish.height);
}

// The size of this format that is nearest to the wish, of equal ones the fastest.
Candidate nearest_size(Io& io, int fd, const std::string& device, const Wish& wish,
                       const FormatOffer& offer, int preference) {
  Candidate best{offer.fourcc, wish.width, wish.height, 0.0, preference};
  bool any = false;
  for (const SizeOffer& size : offer.sizes) {
    Candidate one = best;
    one.width = nearest_step(wish.width, size.width, size.max_width, size.step_x);
    one.height = nearest_step(wish.height, size.height, size.max_height, size.step_y);
    one.fps = size.fps;
    const int64_t error = size_error(wish, one.width, one.height);
    const int64_t least = size_error(wish, best.width, best.height);
    if (!any || error < least || (error == least && one.fps > best.fps)) best = one;
    any = true;
  }
  // What a range says of its smallest size need not hold here.
  best.fps = highest_rate(io, fd, device, best.fourcc, best.width, best.height);
  return best;
}

// Right size before right rate before cheap format; a rate that is not said is taken as right.
bool better(const Wish& wish, const Candidate& a, const Candidate& b) {
  const auto key = [&wish](const Candidate& one) {
    const bool fast = one.fps == 0.0 || one.fps > wish.fps * (1.0 - kSameRate);
    return std::make_tuple(size_error(wish, one.width, one.height), fast ? 0.0 : -one.fps,
                           fast ? 0 : 1, one.preference);
  };
  const auto [size_a, slow_a, late_a, preference_a] = key(a);
  const auto [size_b, slow_b, late_b, preference_b] = key(b);
  return std::tie(size_a, late_a, slow_a, preference_a) <
         std::tie(size_b, late_b, slow_b, preference_b);
}

std::string names_of(const std::vector<FormatOffer>& offers) {
  std::string names;
  for (const FormatOffer& offer : offers) {
    names += (names.empty() ? "" : ", ") + fourcc_text(offer.fourcc);
  }
  return names.empty() ? "nothing" : names;
}

Candidate choose(Io& io, int fd, const std::string& device, const Wish& wish) {
  const std::vector<FormatOffer> offers = read_offers(io, fd, device);
  const std::vector<uint32_t>& usable = usable_formats();
  Candidate best{0, 0, 0, 0.0, 0};
  for (const FormatOffer& offer : offers) {
    const auto known = std::find(usable.begin(), usable.end(), offer.fourcc);
    if (known == usable.end() || (wish.fourcc != 0 && offer.fourcc != wish.fourcc)) continue;
    const Candidate one =
        nearest_size(io, fd, device, wish, offer, static_cast<int>(known - usable.begin()));
    if (best.fourcc == 0 || better(wish, one, best)) best = one;
  }
  if (best.fourcc == 0) {
    const std::string wanted =
        wish.fourcc != 0 ? fourcc_text(wish.fourcc) : "any of " + usable_formats_text();
    throw DeviceError(UNISIM_V4L2_NO_CAMERA, 0,
                      device + ": does not offer " + wanted + " but " + names_of(offers) +
                          ": take another format or camera");
  }
  return best;
}

v4l2_format set_format(Io& io, int fd, const std::string& device, const Candidate& choice) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<uint32_t>(choice.width);
  format.fmt.pix.height = static_cast<uint32_t>(choice.height);
  format.fmt.pix.pixelformat = choice.fourcc;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const int status = ioctl_again(io, fd, VIDIOC_S_FMT, &format);
  if (status < 0) throw call_failed(device, "VIDIOC_S_FMT", -status);
  return format;
}

// @return what became of the rate, 0: not said
double set_rate(Io& io, int fd, const std::string& device, double fps,
                std::vector<std::string>* notes) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  // To a thousandth of a frame: 29.97 is a rate people ask for.
  parameters.parm.capture.timeperframe = {1000, static_cast<uint32_t>(std::lround(fps * 1000))};
  int status = ioctl_again(io, fd, VIDIOC_S_PARM, &parameters);
  if (status < 0) {
    if (means_unplugged(-status)) throw call_failed(device, "VIDIOC_S_PARM", -status);
    notes->push_back(device + ": the frame rate cannot be set: it is what the camera makes of it");
    return 0.0;
  }
  v4l2_streamparm actual{};
  actual.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  status = ioctl_again(io, fd, VIDIOC_G_PARM, &actual);
  if (status < 0 && means_unplugged(-status)) throw call_failed(device, "VIDIOC_G_PARM", -status);
  const v4l2_fract interval = (status < 0 ? parameters : actual).parm.capture.timeperframe;
  if (interval.numerator == 0 || interval.denominator == 0) return 0.0;
  return double(interval.denominator) / interval.numerator;
}

Mode mode_of(const v4l2_pix_format& pixels, const std::string& device) {
  Mode mode{};
  mode.fourcc = pixels.pixelformat;
  mode.width = static_cast<int32_t>(pixels.width);
  mode.height = static_cast<int32_t>(pixels.height);
  const std::vector<uint32_t>& usable = usable_formats();
  if (std::find(usable.begin(), usable.end(), mode.fourcc) == usable.end()) {
    throw DeviceError(UNISIM_V4L2_FAILED, 0,
                      device + ": insists on format " + fourcc_text(mode.fourcc) +
                          ", which cannot be read: take another camera");
  }
  // A gigapixel and no pixel are both a broken driver.
  if (mode.width <= 0 || mode.height <= 0 || mode.width > 32768 || mode.height > 32768) {
    throw DeviceError(UNISIM_V4L2_FAILED, 0,
                      device + ": insists on size " + drivers::size_text(mode.width, mode.height) +
                          ": take another camera");
  }
  const int32_t row = row_bytes(mode.fourcc, mode.width);
  // Some drivers leave the stride at 0, or fill in that of another format.
  const bool sane = pixels.bytesperline < (1U << 24);
  mode.stride = row == 0 ? 0 : std::max(row, sane ? static_cast<int32_t>(pixels.bytesperline) : 0);
  mode.needed_bytes = needed_bytes(mode.fourcc, mode.width, mode.height, mode.stride);
  return mode;
}

void note_changes(const std::string& device, const Wish& wish, const v4l2_pix_format& pixels,
                  const Mode& mode, std::vector<std::string>* notes) {
  if (mode.width != wish.width || mode.height != wish.height) {
    notes->push_back(device + ": gives " + drivers::size_text(mode.width, mode.height) +
                     " instead of " + drivers::size_text(wish.width, wish.height));
  }
  if (wish.fourcc != 0 && mode.fourcc != wish.fourcc) {
    notes->push_back(device + ": gives " + fourcc_text(mode.fourcc) + " instead of " +
                     fourcc_text(wish.fourcc));
  }
  if (mode.fps > 0 && std::abs(mode.fps - wish.fps) > kSameRate * wish.fps) {
    notes->push_back(device + ": gives " + rate_text(mode.fps) + " frames per second instead of " +
                     rate_text(wish.fps));
  }
  if (pixels.field != V4L2_FIELD_NONE && pixels.field != V4L2_FIELD_ANY) {
    notes->push_back(device + ": gives interlaced frames, which blur where the camera moves");
  }
}

}  // namespace

Mode negotiate(Io& io, int fd, const std::string& device, const Wish& wish,
               std::vector<std::string>* notes) {
  const Candidate choice = choose(io, fd, device, wish);
  const v4l2_format format = set_format(io, fd, device, choice);
  Mode mode = mode_of(format.fmt.pix, device);
  // After the format: many drivers go back to their own rate when it is set.
  mode.fps = set_rate(io, fd, device, wish.fps, notes);
  note_changes(device, wish, format.fmt.pix, mode, notes);
  return mode;
}

}  // namespace unisim::v4l2
