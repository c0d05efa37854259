// SPDX-License-Identifier: MIT
// Rows of an image that are read one after the other.
#pragma once

#include <opencv2/core.hpp>

#include "drivers/geometric/map/state.hpp"

namespace unisim::geometric {

/// Sway of a point: pixels by which it is off for each second that the readout of an image takes.
///
/// A row above the middle is read before the time of the image, one below after it, by up to half
/// of the readout; meanwhile the point moves on as it did from frame to frame. That motion is
/// measured for each track, depth and turn of the camera are in it, so that the adjustment has one
/// unknown for all images, the readout, and no velocities: pixel - readout * sway is where a camera
/// would see the point that reads all rows at once.
cv::Point2f sway_of(const State& state, const cv::Point2f& at, const cv::Point2f& motion_px);

/// After the first frame that follows a keyframe: what its observations saw before and after it is
/// averaged; motion is then that of the keyframe's own time.
void see_motion_after(State* state);

}  // namespace unisim::geometric
