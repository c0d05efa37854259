// SPDX-License-Identifier: MIT
// What is known of the camera, and which of its numbers the images can tell at present.
#include "drivers/geometric/start/intrinsics.hpp"

#include <algorithm>
#include <cmath>

namespace unisim::geometric {

namespace {
constexpr double kStartFocal = 0.85;  // of the longer side
constexpr double kStartSigma = 0.3;   // of log focal length
constexpr double kK1Sigma = 0.02;
constexpr double kK1Wide = 0.05;  // beyond what lenses have that are not meant to be wide
// rad. Freed later, the focal length of a wide lens has run away to explain what the lens bends.
constexpr double kK1MinRotation = 0.05;
// The principal point of a camera that is sold as one lies within 1-3 % of the middle. Redkitchen
// says (318, 246) whatever the start frame; ATE, mean of five, with a prior of 0.25, 0.5, 1, 2 % of
// the diagonal: .0053 (held) .0050 .0051 .0053. Rendered rooms, whose point is the middle: 0.3 px.
constexpr double kCenterSigma = 0.005;      // of the image diagonal
constexpr double kCenterMinRotation = 0.2;  // rad
constexpr double kMostCenterShift = 0.1;    // of the image diagonal
// Seconds: what reads rows one after the other takes most of the time between two frames for it.
constexpr double kReadoutSigma = 0.02;
constexpr double kMostReadout = 0.2;
constexpr double kReadoutMinRotation = 0.05;  // rad
constexpr double kMinFocal = 0.3;             // of the image width
constexpr double kMaxFocal = 3.0;
}  // namespace

Intrinsics Intrinsics::start(const cv::Size& size, double focal_px, bool k1_known,
                             bool center_known) {
  Intrinsics out;
  out.focal_known = focal_px > 0;
  out.k1_known = k1_known;
  out.start_focal = out.focal_known ? focal_px : kStartFocal * std::max(size.width, size.height);
  out.camera.focal_px = out.start_focal;
  out.center_known = center_known;
  out.middle = cv::Point2d(size.width / 2.0 - 0.5, size.height / 2.0 - 0.5);
  out.center_sigma_px = kCenterSigma * std::hypot(size.width, size.height);
  out.camera.cx = out.middle.x;
  out.camera.cy = out.middle.y;
  return out;
}

double Intrinsics::focal_sigma() const {
  if (focal_known) return 0.0;
  return log_focal_sigma > 0.0 ? log_focal_sigma : kStartSigma;
}

bool Intrinsics::k1_observable() const { return turned_rad >= kK1MinRotation; }

bool Intrinsics::center_observable() const { return turned_rad >= kCenterMinRotation; }

bool Intrinsics::readout_observable() const { return turned_rad >= kReadoutMinRotation; }

void Intrinsics::roll(double seconds) {
  rolling = true;
  readout_known = seconds != 0;
  readout_s = seconds;
}

void Intrinsics::note_rotation(double angle_rad) { turned_rad = std::max(turned_rad, angle_rad); }

void Intrinsics::give(bool early, BundleIntrinsics* out) const {
  out->set_model(camera);
  out->free_focal = !focal_known;
  out->free_k1 = !k1_known && k1_observable();
  out->log_focal_mean = std::log(start_focal);
  out->log_focal_sigma = early ? kStartSigma : 0.0;
  out->free_center = !center_known && !early && center_observable();
  out->readout_s = readout_s;
  out->free_readout = rolling && !readout_known && !early && readout_observable();
  out->readout_sigma_s = kReadoutSigma;
  out->cx_mean = middle.x;
  out->cy_mean = middle.y;
  out->center_sigma_px = center_sigma_px;
  out->k1_mean = 0.0;
  // A heavy tail towards barrel distortion, which wide lenses have: weak evidence, as in straight
  // driving, is held near 0, strong evidence pays little for going far. No lens goes far the other
  // way.
  out->k1_sigma = std::hypot(kK1Sigma, std::max(0.0, camera.k1 - kK1Wide));
}

void Intrinsics::take(const BundleIntrinsics& in, const cv::Size& size) {
  const CameraModel model = in.model();
  if (!std::isfinite(model.focal_px) || !std::isfinite(model.k1) || !std::isfinite(model.cx) ||
      !std::isfinite(model.cy) || !std::isfinite(in.readout_s)) {
    return;
  }
  const double reach = kMostCenterShift * std::hypot(size.width, size.height);
  camera.k1 = model.k1;
  if (!readout_known) readout_s = std::clamp(in.readout_s, -kMostReadout, kMostReadout);
  camera.cx = std::clamp(model.cx, middle.x - reach, middle.x + reach);
  camera.cy = std::clamp(model.cy, middle.y - reach, middle.y + reach);
  if (focal_known) return;
  camera.focal_px = std::clamp(model.focal_px, kMinFocal * size.width, kMaxFocal * size.width);
}

void Intrinsics::archive(drivers::Archive* io, const cv::Size& size) {
  constexpr double kMostK1 = 1e3;
  io->part("camera");
  double focal = camera.focal_px;
  if (focal_known) {
    io->number(focal);  // given, and any: what start() was told stays
  } else {
    io->number(focal, kMinFocal * size.width, kMaxFocal * size.width);
    camera.focal_px = focal;
  }
  io->number(camera.k1, -kMostK1, kMostK1);
  const double reach = kMostCenterShift * std::hypot(size.width, size.height);
  double cx = camera.cx;
  double cy = camera.cy;
  io->number(cx, middle.x - reach, middle.x + reach);
  io->number(cy, middle.y - reach, middle.y + reach);
  if (!center_known) {
    camera.cx = cx;
    camera.cy = cy;
  }
  io->number(turned_rad, 0.0, 4.0);
  io->number(log_focal_sigma, 0.0, 1e9);
}

}  // namespace unisim::geometric
