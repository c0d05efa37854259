// SPDX-License-Identifier: MIT
// The ground under the cameras of a window.
#include "drivers/pipeline/ground_plane.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "drivers/common/median.hpp"
#include "drivers/pipeline/similarity.hpp"

namespace unisim::pipeline {
namespace {

// Chosen on kitti 06 (49 frames of a car) and the rendered corridor, shown on other seeds of it and
// the rendered room.
constexpr double kTop = 0.6;  // of the image, from above: nearer to a horizon depth says little
// Of the geometric predictor cells with a landmark, of networks the surest quarter.
constexpr float kSure = 0.75F;
constexpr size_t kMostSamples = 3000;
constexpr int kTries = 400;
constexpr double kSteepest = 0.7;     // of the plane against what the camera calls down: 35 degrees
constexpr double kTolerance = 0.06;   // of the height: what relative errors of depth come to
constexpr double kMostSpread = 0.08;  // of the cameras' heights, relative
constexpr int kFewestPoints = 60;
constexpr double kLeastShare = 0.3;   // of the samples
constexpr double kMostBelow = 0.2;    // of the points in the plane: landmarks that are wrong
constexpr double kLeastSigma = 0.04;  // of a window: what its points share

/// Reproducible numbers in [0, count).
class Choice {
 public:
  size_t next(size_t count) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<size_t>((state_ >> 33) % count);
  }

 private:
  uint64_t state_ = 88172645463325252ULL;
};

Eigen::Quaterniond rotation(const unisim_sim3& T) {
  return Eigen::Quaterniond(T.q[3], T.q[0], T.q[1], T.q[2]);
}

/// down = a x + b y + c, in a frame whose third axis points down.
struct Plane {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
  double below(const Eigen::Vector3d& p) const { return p[2] - a * p[0] - b * p[1] - c; }
};

bool plane_through(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                   Plane* plane) {
  const Eigen::Vector3d n = (q - p).cross(r - p);
  if (!(std::hypot(n[0], n[1]) < kSteepest * std::abs(n[2]))) return false;
  plane->a = -n[0] / n[2];
  plane->b = -n[1] / n[2];
  plane->c = p[2] - plane->a * p[0] - plane->b * p[1];
  return true;
}

class GroundSearch {
 public:
  GroundPlane run(const unisim_window_prediction& window, int32_t image_width,
                  int32_t image_height);

 private:
  void take_samples(const unisim_window_prediction& window, double width, double height);
  bool turn_down(const unisim_window_prediction& window);
  double height_over(const Plane& plane, double* spread);
  double cost_of(const Plane& plane, double tolerance) const;
  bool fit(double tolerance, Plane* plane) const;
  GroundPlane judge(const Plane& plane, double height, double spread) const;

  std::vector<Eigen::Vector3d> samples_;  // of the window, then with down
  std::vector<Eigen::Vector3d> cameras_;
  std::vector<double> heights_;
};

/// The sure cells of the lower part of each view.
void GroundSearch::take_samples(const unisim_window_prediction& window, double width,
                                double height) {
  samples_.clear();
  for (int32_t view = 0; view < window.count; ++view) {
    const unisim_depth_map& map = window.depth[view];
    const int top = static_cast<int>(kTop * map.height);
    for (int row = top; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        const size_t cell =
            static_cast<size_t>(row) * static_cast<size_t>(map.width) + static_cast<size_t>(column);
        const double depth = map.depth[cell];
        const float sure = map.confidence != nullptr ? map.confidence[cell] : 1.0F;
        if (!std::isfinite(depth) || !(depth > 0.0) || !(sure >= kSure)) continue;
        const double x = ((column + 0.5) / map.width - 0.5) * width;
        const double y = ((row + 0.5) / map.height - 0.5) * height;
        const unisim_sim3 at = {{0.0, 0.0, 0.0, 1.0}, {x * depth, y * depth, depth}, 1.0};
        const unisim_sim3 place = compose(window.T_window_kf[view], at);
        samples_.emplace_back(place.t);
      }
    }
  }
  if (samples_.size() <= kMostSamples) return;
  for (size_t k = 0; k < kMostSamples; ++k) {
    samples_[k] = samples_[k * samples_.size() / kMostSamples];
  }
  samples_.resize(kMostSamples);
}

/// Samples and cameras get a frame whose third axis is what the cameras on the whole call down.
bool GroundSearch::turn_down(const unisim_window_prediction& window) {
  Eigen::Vector3d down = Eigen::Vector3d::Zero();
  for (int32_t view = 0; view < window.count; ++view) {
    down += rotation(window.T_window_kf[view]) * Eigen::Vector3d::UnitY();
  }
  constexpr double kLeast = 1e-9;  // of views that look all ways
  if (!(down.norm() > kLeast)) return false;
  down.normalize();
  Eigen::Matrix3d turn;
  turn.row(0) = down.unitOrthogonal();
  turn.row(1) = down.cross(turn.row(0).transpose());
  turn.row(2) = down;
  for (Eigen::Vector3d& sample : samples_) sample = turn * sample;
  cameras_.clear();
  for (int32_t view = 0; view < window.count; ++view) {
    cameras_.emplace_back(turn * Eigen::Vector3d(window.T_window_kf[view].t));
  }
  return true;
}

/// Median height of the cameras. @param[out] spread relative
double GroundSearch::height_over(const Plane& plane, double* spread) {
  const double slant = std::sqrt(1.0 + plane.a * plane.a + plane.b * plane.b);
  heights_.clear();
  for (const Eigen::Vector3d& camera : cameras_) heights_.push_back(-plane.below(camera) / slant);
  const double height = drivers::median(&heights_);
  for (double& one : heights_) one = std::abs(one - height);
  constexpr double kNormal = 1.4826;  // standard deviations per median absolute deviation
  *spread = height > 0.0 ? kNormal * drivers::median(&heights_) / height : 1.0;
  return height;
}

/// Points in the plane count by how near they are, those below it against it.
double GroundSearch::cost_of(const Plane& plane, double tolerance) const {
  double cost = 0.0;
  for (const Eigen::Vector3d& sample : samples_) {
    const double below = plane.below(sample) / tolerance;
    cost += below > 3.0 ? 2.0 : std::min(1.0, below * below);
  }
  return cost;
}

/// Least squares of the points in the plane.
bool GroundSearch::fit(double tolerance, Plane* plane) const {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& sample : samples_) {
    if (std::abs(plane->below(sample)) > tolerance) continue;
    const Eigen::Vector3d row(sample.x(), sample.y(), 1.0);
    A += row * row.transpose();
    b += row * sample.z();
  }
  constexpr double kLeastDeterminant = 1e-12;
  Eigen::Matrix3d inverse;
  bool invertible = false;
  A.computeInverseWithCheck(inverse, invertible, kLeastDeterminant);
  if (!invertible) return false;
  const Eigen::Vector3d x = inverse * b;
  *plane = {x[0], x[1], x[2]};
  return true;
}

GroundPlane GroundSearch::judge(const Plane& plane, double height, double spread) const {
  GroundPlane ground;
  int below = 0;
  double squares = 0.0;
  for (const Eigen::Vector3d& sample : samples_) {
    const double off = plane.below(sample) / height;
    if (std::abs(off) <= kTolerance) {
      ++ground.points;
      squares += off * off;
    }
    below += off > 3.0 * kTolerance ? 1 : 0;
  }
  if (ground.points < kFewestPoints ||
      ground.points < kLeastShare * static_cast<double>(samples_.size())) {
    ground.reason = "too few points lie in one plane below the camera";
  } else if (below > kMostBelow * ground.points) {
    ground.reason = "there is something below the plane: a table, not the ground";
  } else if (spread > kMostSpread) {
    ground.reason = "the camera's height over the plane changes";
  } else {
    ground.height = height;
    // Points near each other err alike: a tenth of them count.
    const double of_plane = std::sqrt(squares / ground.points) / std::sqrt(0.1 * ground.points);
    const double of_cameras = spread / std::sqrt(static_cast<double>(cameras_.size()) / 4.0);
    ground.sigma = std::max(kLeastSigma, std::hypot(of_plane, of_cameras));
  }
  return ground;
}

GroundPlane GroundSearch::run(const unisim_window_prediction& window, int32_t image_width,
                              int32_t image_height) {
  GroundPlane none;
  none.reason = "the window has no depth, or does not know its focal length";
  if (!(window.focal_px > 0.0) || window.count < 2) return none;
  take_samples(window, image_width / window.focal_px, image_height / window.focal_px);
  if (samples_.size() < static_cast<size_t>(kFewestPoints) || !turn_down(window)) return none;
  Choice choice;
  Plane best;
  double best_cost = 0.0;
  double height = 0.0;
  double spread = 0.0;
  const size_t count = samples_.size();
  for (int k = 0; k < kTries; ++k) {
    const Eigen::Vector3d& p = samples_[choice.next(count)];
    const Eigen::Vector3d& q = samples_[choice.next(count)];
    const Eigen::Vector3d& r = samples_[choice.next(count)];
    Plane plane;
    if (!plane_through(p, q, r, &plane)) continue;
    const double here = height_over(plane, &spread);
    if (!(here > 0.0) || spread > 3.0 * kMostSpread) continue;
    const double cost = cost_of(plane, kTolerance * here);
    if (height > 0.0 && cost >= best_cost) continue;
    best = plane;
    best_cost = cost;
    height = here;
  }
  none.reason = "no plane below the camera that stays as far from it";
  if (!(height > 0.0)) return none;
  for (int round = 0; round < 3; ++round) {
    if (!fit(kTolerance * height, &best)) return none;
    height = height_over(best, &spread);
    if (!(height > 0.0)) return none;
  }
  return judge(best, height, spread);
}

}  // namespace

GroundPlane find_ground(const unisim_window_prediction& window, int32_t image_width,
                        int32_t image_height) {
  return GroundSearch().run(window, image_width, image_height);
}

}  // namespace unisim::pipeline
