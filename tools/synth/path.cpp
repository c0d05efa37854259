// SPDX-License-Identifier: MIT
// Camera paths of the scenes.
#include "tools/synth/path.hpp"

#include <algorithm>
#include <cmath>

#include "tools/synth/random.hpp"

namespace unisim::synth {
namespace {

using Eigen::Vector3d;

constexpr double kTwoPi = 6.283185307179586;
/// A round goes on for this share more, so that its start is seen again.
constexpr double kOverlap = 1.07;
constexpr double kWalkSpeed = 1.1;  // metres per second

double smooth_step(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

Eigen::Matrix3d look_at(const Vector3d& eye, const Vector3d& target) {
  const Vector3d forward = (target - eye).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R_world_cam;
  R_world_cam << right, forward.cross(right), forward;
  return R_world_cam;
}

bool stands_still(SceneKind scene) {
  return scene == SceneKind::kRotation || scene == SceneKind::kStatic;
}

}  // namespace

Sway::Sway(double amplitude, uint64_t seed) {
  Random random(seed);
  double frequency = 0.22;  // hertz
  const double slowest = frequency;
  for (Sine& sine : sines_) {
    const double f = frequency * random.uniform(0.8, 1.25);
    sine = {amplitude * slowest / f, kTwoPi * f, random.uniform(0, kTwoPi)};
    frequency *= 1.9;
  }
}

double Sway::at(double time_s) const {
  double sum = 0;
  for (const Sine& sine : sines_) {
    sum += sine.amplitude * std::sin(sine.frequency_rad * time_s + sine.phase);
  }
  return sum;
}

CameraPath::CameraPath(const PathOptions& options)
    : options_(options),
      start_(Random(derive_seed(options.seed, 500)).uniform(0, kTwoPi)),
      position_sway_{Sway(stands_still(options.scene) ? 0 : 0.035, derive_seed(options.seed, 501)),
                     Sway(stands_still(options.scene) ? 0 : 0.035, derive_seed(options.seed, 502)),
                     Sway(stands_still(options.scene) ? 0 : 0.03, derive_seed(options.seed, 503))},
      rotation_sway_{
          Sway(options.scene == SceneKind::kStatic ? 0 : 0.028, derive_seed(options.seed, 504)),
          Sway(options.scene == SceneKind::kStatic ? 0 : 0.028, derive_seed(options.seed, 505)),
          Sway(options.scene == SceneKind::kStatic ? 0 : 0.022, derive_seed(options.seed, 506))} {}

double CameraPath::progress(double time_s) const {
  // Starts at a third of the mean speed and gains the rest within the first tenth.
  constexpr double kStartSpeed = 0.33;
  constexpr double kRamp = 0.05;
  const auto eased = [](double u) {
    return u - (1 - kStartSpeed) * kRamp * (1 - std::exp(-u / kRamp));
  };
  return eased(time_s / options_.duration_s) / eased(1);
}

CameraPath::View CameraPath::orbit_room(double rounds) const {
  const double angle = start_ + kTwoPi * rounds;
  const Vector3d eye(1.35 * std::cos(angle), 0.95 * std::sin(angle),
                     1.45 + 0.12 * std::sin(2 * angle));
  // The gaze wanders around the middle of the room at its own pace.
  const Vector3d target(0.45 * std::cos(2.0 * angle + 1), 0.35 * std::sin(1.5 * angle), 1.2);
  return {eye, target};
}

CameraPath::View CameraPath::walk_corridor(double progress) const {
  constexpr double kSide = 0.35;
  const double longest = kCorridorSize.x() - 5;
  const double start_x = -longest / 2;
  if (options_.loops == 0) {
    const double reach = std::min(longest, kWalkSpeed * options_.duration_s);
    const Vector3d eye(start_x + reach * progress, 0, 1.5);
    return {eye, eye + Vector3d(3, 0.15 * std::sin(6 * progress), -0.25)};
  }
  // Out on one side, turn, back on the other, turn.
  constexpr double kTurn = 0.15;
  constexpr double kStraight = 0.5 - kTurn;
  const double seconds_per_round = options_.duration_s / options_.loops;
  const double reach = std::min(longest, 0.6 * kWalkSpeed * kStraight * seconds_per_round);
  const double rounds = progress * options_.loops;
  const double part = rounds - std::floor(rounds);
  const bool back = part >= 0.5;
  const double half = back ? part - 0.5 : part;
  const double along = smooth_step(half / kStraight);
  const double turn = kTwoPi / 2 * (smooth_step((half - kStraight) / kTurn) + (back ? 1 : 0));
  const double x = start_x + reach * (back ? 1 - along : along);
  const Vector3d heading(std::cos(turn), std::sin(turn), 0);
  // On the circle of the turn the camera is kSide to the right of its heading.
  const Vector3d eye = Vector3d(x, 0, 1.5) + kSide * Vector3d(heading.y(), -heading.x(), 0);
  return {eye, eye + 3 * heading - Vector3d(0, 0, 0.25)};
}

CameraPath::View CameraPath::swing_at_desk(double progress) const {
  const double swing = options_.loops == 0 ? 2 * progress - 1
                                           : std::sin(kTwoPi * options_.loops * progress + start_);
  const double lift = std::sin(2.6 * kTwoPi * std::max(1, options_.loops) * progress);
  const double azimuth = 0.75 * swing;
  const double distance = 1.15 + 0.12 * std::cos(3 * azimuth + start_);
  const Vector3d middle = kDeskCenter + Vector3d(0, 0, 0.08);
  const Vector3d eye = middle + Vector3d(distance * std::sin(azimuth),
                                         -distance * std::cos(azimuth), 0.55 + 0.1 * lift);
  return {eye, middle + Vector3d(0.12 * swing, 0.05, 0.03)};
}

CameraPath::View CameraPath::steady_view(double progress) const {
  const double rounds = options_.loops == 0 ? 0.7 * progress : options_.loops * kOverlap * progress;
  switch (options_.scene) {
    case SceneKind::kCorridor:
      return walk_corridor(progress);
    case SceneKind::kDesk:
      return swing_at_desk(progress);
    case SceneKind::kRotation: {
      const double angle = start_ + kTwoPi * rounds;
      const Vector3d eye(0.2, 0.1, 1.4);
      return {eye, eye + Vector3d(std::cos(angle), std::sin(angle), -0.15)};
    }
    case SceneKind::kStatic:
      return orbit_room(0);
    case SceneKind::kRoom:
    case SceneKind::kLowTexture:
      break;
  }
  return orbit_room(rounds);
}

Eigen::Isometry3d CameraPath::T_world_cam(double time_s) const {
  const View view = steady_view(progress(time_s));
  const auto sway = [time_s](const std::array<Sway, 3>& axes) {
    return Vector3d(axes[0].at(time_s), axes[1].at(time_s), axes[2].at(time_s));
  };
  const Vector3d turn = sway(rotation_sway_);
  Eigen::Isometry3d T_world_cam = Eigen::Isometry3d::Identity();
  T_world_cam.translation() = view.eye + sway(position_sway_);
  T_world_cam.linear() = look_at(view.eye, view.target) *
                         Eigen::AngleAxisd(turn.x(), Vector3d::UnitX()) *
                         Eigen::AngleAxisd(turn.y(), Vector3d::UnitY()) *
                         Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()).toRotationMatrix();
  return T_world_cam;
}

}  // namespace unisim::synth
