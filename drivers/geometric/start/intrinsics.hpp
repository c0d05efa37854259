// SPDX-License-Identifier: MIT
// What is known of the camera, and which of its numbers the images can tell at present.
#pragma once

#include <opencv2/core.hpp>

#include "drivers/common/archive.hpp"
#include "drivers/geometric/bundle/bundle_problem.hpp"

namespace unisim::geometric {

/// Focal length, radial term and principal point: start values, priors and the rule by which they
/// are freed.
///
/// The focal length starts at 0.85 of the longer side. The radial term stays 0 until the camera has
/// turned enough: in straight driving it cannot be told from the path and would bend it. So does
/// the principal point stay in the middle, which takes more: a point off the middle looks like a
/// camera that is turned a little.
struct Intrinsics {
  CameraModel camera;
  bool focal_known = false;
  bool k1_known = false;      ///< the images come from an ideal camera
  bool center_known = false;  ///< the principal point is the middle
  double start_focal = 0;
  cv::Point2d middle;          ///< of the image, pixels
  double center_sigma_px = 0;  ///< of the prior on the principal point
  double turned_rad = 0;       ///< largest rotation seen within a segment
  double log_focal_sigma = 0;  ///< from the last adjustment of the whole state, 0: not known
  bool rolling = false;        ///< rows are read one after the other
  bool readout_known = false;  ///< how long that takes
  double readout_s = 0;        ///< from the first row of an image to the last; negative: from below

  /// @param focal_px known focal length or 0
  static Intrinsics start(const cv::Size& size, double focal_px, bool k1_known = false,
                          bool center_known = false);
  /// Of log focal length: 0 where it is given, that of the guess until it has been measured.
  double focal_sigma() const;
  bool k1_observable() const;
  bool center_observable() const;
  bool readout_observable() const;
  /// Rows are read one after the other. @param seconds from first to last, 0: not known
  void roll(double seconds);
  /// Notes a camera turned by `angle_rad` against the segment's start.
  void note_rotation(double angle_rad);
  /// Sets values, freedoms and priors of a problem.
  /// @param early the state is young: the start's prior on the focal length still holds
  void give(bool early, BundleIntrinsics* out) const;
  /// Takes values back, within sane limits.
  void take(const BundleIntrinsics& in, const cv::Size& size);
  /// Saves or loads what has been learnt; what was given stays as start() was told.
  void archive(drivers::Archive* io, const cv::Size& size);
};

}  // namespace unisim::geometric
