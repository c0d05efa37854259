// SPDX-License-Identifier: MIT
// Pose of a camera from points of which most are wrong.
#include "drivers/geometric/places/pose_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "drivers/geometric/places/pose_fit.hpp"

namespace unisim::geometric {

namespace {

// Three right ones among a fifth that are right come up once in 125 tries.
constexpr size_t kRounds = 300;
constexpr size_t kFirst = 10;      // the most trusted, from which the first rounds draw
constexpr double kEnough = 0.001;  // chance that a better pose was missed

/// A generator of our own: the standard ones may differ between libraries.
class Draw {
 public:
  size_t below(size_t count) {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_ % count;
  }

 private:
  uint32_t state_ = 2463534242U;
};

std::array<size_t, 3> draw_three(size_t count, Draw* draw) {
  std::array<size_t, 3> out{};
  out[0] = draw->below(count);
  do out[1] = draw->below(count);
  while (out[1] == out[0]);
  do out[2] = draw->below(count);
  while (out[2] == out[0] || out[2] == out[1]);
  return out;
}

int count_within(const CameraModel& camera, const std::vector<PoseObservation>& observations,
                 double gate, const CameraPose& pose) {
  return static_cast<int>(
      std::count_if(observations.begin(), observations.end(),
                    [&](const PoseObservation& seen) { return agrees(camera, pose, seen, gate); }));
}

/// Rounds after which a share of right ones has come up together but for a chance of kEnough.
double rounds_for(double share) {
  const double all_right = share * share * share;
  return all_right < 1 ? std::log(kEnough) / std::log(1 - all_right) : 0;
}

}  // namespace

int search_pose(const CameraModel& camera, const std::vector<PoseObservation>& observations,
                double gate, CameraPose* pose) {
  const size_t count = observations.size();
  if (count < kFirst) return 0;
  const cv::Matx33d calibration(camera.focal_px, 0, camera.cx, 0, camera.focal_px, camera.cy, 0, 0,
                                1);
  std::vector<cv::Point3d> points(3);
  std::vector<cv::Point2d> pixels(3);
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  Draw draw;
  int best = 0;
  double needed = kRounds;
  for (size_t round = 0; round < kRounds && static_cast<double>(round) < needed; ++round) {
    // From few to all of them by half time.
    const size_t among = std::min(count, kFirst + (count - kFirst) * 2 * round / kRounds);
    const std::array<size_t, 3> three = draw_three(among, &draw);
    for (size_t k = 0; k < 3; ++k) {
      const PoseObservation& seen = observations[three[k]];
      points[k] = {seen.point_world.x(), seen.point_world.y(), seen.point_world.z()};
      pixels[k] = {seen.undistorted_px.x(), seen.undistorted_px.y()};
    }
    const int solutions = cv::solveP3P(points, pixels, calibration, cv::noArray(), rotations,
                                       translations, cv::SOLVEPNP_AP3P);
    for (int s = 0; s < solutions; ++s) {
      const auto* r = rotations[static_cast<size_t>(s)].ptr<double>();
      const auto* t = translations[static_cast<size_t>(s)].ptr<double>();
      CameraPose candidate;
      candidate.R = rotation_exp({r[0], r[1], r[2]});
      candidate.t = {t[0], t[1], t[2]};
      if (!candidate.R.allFinite() || !candidate.t.allFinite()) continue;
      const int agree = count_within(camera, observations, gate, candidate);
      if (agree <= best) continue;
      best = agree;
      *pose = candidate;
      needed = rounds_for(static_cast<double>(best) / static_cast<double>(count));
    }
  }
  return best;
}

}  // namespace unisim::geometric
