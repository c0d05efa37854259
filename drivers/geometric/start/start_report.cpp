// SPDX-License-Identifier: MIT
// The one line about a run that found no start.
#include "drivers/geometric/start/start_report.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/common/format.hpp"
#include "drivers/predictor.h"

namespace unisim::geometric {

namespace {

using drivers::format;

// What counts as the image's darkest and brightest: a few hot pixels or a lamp do not.
constexpr double kDarkest = 0.01;
constexpr double kBrightest = 0.99;
// Noise and rounding take much of what such images show.
constexpr int kTooDark = 32;
constexpr int kTooBright = 224;
constexpr int kTooFlat = 32;
// Features held fast by an overlay: more than those of a far background that seem to stand still.
constexpr double kRestingShare = 0.25;
constexpr double kMovingShare = 0.1;
// Of the features; where fewer are followed, those that are have mostly slipped.
constexpr double kMinFollowed = 0.4;

struct Reason {
  StartOutcome outcome;
  int32_t code;  // UNISIM_REASON_*
  const char* name;
  const char* advice;
};

constexpr Reason kReasons[] = {
    {StartOutcome::kTooFewFeatures, UNISIM_REASON_TEXTURE, "too few features",
     "the images show too little texture (as depth images do): light the scene better, focus, look "
     "at more than bare "
     "surfaces"},
    {StartOutcome::kTracksDie, UNISIM_REASON_LOST_TRACKS, "features lost between keyframes",
     "keyframes differ too much to follow features: lower --stride, move slower or record more "
     "frames per second"},
    {StartOutcome::kNotMoving, UNISIM_REASON_STILL, "not enough motion",
     "not enough motion between the images: move the camera sideways"},
    {StartOutcome::kRotationOnly, UNISIM_REASON_TURNED, "only turned",
     "the camera only turned on the spot: move it sideways as well"},
    {StartOutcome::kNoParallax, UNISIM_REASON_PARALLAX, "too little parallax",
     "the camera hardly changed its place compared with the distance of what it sees: move it "
     "farther sideways"},
    {StartOutcome::kNoGeometry, UNISIM_REASON_NOT_RIGID, "no rigid scene",
     "the features do not move as a rigid scene does before one camera: cuts, keyframes too far "
     "apart (lower --stride), moving things, a fisheye lens or hardly any parallax do this"}};

constexpr const Reason& reason_of(StartOutcome outcome) {
  const Reason* reason = kReasons;
  while (reason->outcome != outcome) ++reason;
  return *reason;
}

std::string counted(long long count, const char* thing) {
  return format("%lld %s%s", count, thing, count == 1 ? "" : "s");
}

std::string what_was_seen(const StartStatistics& seen, const cv::Size& size) {
  std::string line = counted(seen.frames, "frame") + " of " +
                     format("%dx%d", size.width, size.height) + ", " +
                     counted(seen.keyframes, "keyframe");
  line += format(", grey levels %d to %d of 255", seen.level(kDarkest), seen.level(kBrightest));
  if (seen.keyframes == 0) return line;
  line +=
      format(", %.0f features per keyframe", static_cast<double>(seen.features) / seen.keyframes);
  if (seen.followed_keyframes > 0) {
    line += format(", %.0f %% of them followed to the next",
                   100 * seen.followed / seen.followed_keyframes);
  }
  if (seen.moved_keyframes > 0) {
    const double moved = seen.moved_px / seen.moved_keyframes;
    line += format(" and moved %.1f px (%.1f %% of the diagonal)", moved,
                   100 * moved / std::hypot(size.width, size.height));
  }
  return line;
}

int32_t count_of(const StartStatistics& seen, StartOutcome outcome) {
  return seen.outcomes[static_cast<size_t>(outcome)];
}

std::string refusals(const StartStatistics& seen) {
  std::string line;
  for (const Reason& reason : kReasons) {
    const int32_t count = count_of(seen, reason.outcome);
    if (count == 0) continue;
    line += (line.empty() ? "; refused: " : ", ") + std::to_string(count) + " " + reason.name;
  }
  return line;
}

std::string advice(const StartStatistics& seen) {
  if (seen.keyframes < 2) return "a start takes two keyframes or more: lower --stride";
  const int darkest = seen.level(kDarkest);
  const int brightest = seen.level(kBrightest);
  if (brightest < kTooDark) {
    return "the images are too dark: expose longer; pixels of more than 8 bits must use their "
           "whole range";
  }
  if (darkest > kTooBright) return "the images are too bright: expose shorter";
  if (brightest - darkest < kTooFlat) {
    return "the images have hardly any contrast: clean or focus the lens, light the scene better";
  }
  if (seen.two_eyes()) return kTwoEyes;
  const auto measured = static_cast<double>(seen.moving + seen.resting);
  if (static_cast<double>(seen.resting) > kRestingShare * measured &&
      static_cast<double>(seen.moving) > kMovingShare * measured) {
    return format(
        "%.0f %% of the features stay in place while the others move: hide what goes with "
        "the camera (text, logo, own body) by --mask",
        100 * static_cast<double>(seen.resting) / measured);
  }
  const Reason* most = std::max_element(
      std::begin(kReasons), std::end(kReasons), [&](const Reason& a, const Reason& b) {
        return count_of(seen, a.outcome) < count_of(seen, b.outcome);
      });
  const bool lost = seen.followed < kMinFollowed * seen.followed_keyframes;
  return most->outcome == StartOutcome::kNoGeometry && lost
             ? reason_of(StartOutcome::kTracksDie).advice
             : most->advice;
}

}  // namespace

int32_t start_reason(StartOutcome outcome) {
  for (const Reason& reason : kReasons) {
    if (reason.outcome == outcome) return reason.code;
  }
  return UNISIM_REASON_NONE;
}

std::string start_report(const StartStatistics& seen, const cv::Size& size) {
  return "no start: " + what_was_seen(seen, size) + refusals(seen) + "; " + advice(seen);
}

}  // namespace unisim::geometric
