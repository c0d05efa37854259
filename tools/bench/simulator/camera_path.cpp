// SPDX-License-Identifier: MIT
// Hand-held camera paths: sums of slow waves, a round through the flat for walks.
#include "tools/bench/simulator/camera_path.hpp"

#include <cmath>
#include <initializer_list>

namespace unisim::simulator {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kKeyframePeriod = 1.0 / 6.0;  // s
constexpr double kRoomRound = 28.0;            // s per turn
constexpr double kWalkSpeed = 0.5;             // m/s
constexpr double kWalkRound = 28.0;            // m
constexpr double kWalkHalfX = 4.5;
constexpr double kWalkHalfY = 2.5;

// Sum of cosines with random strength and phase.
class Wave {
 public:
  Wave(std::initializer_list<double> frequencies, double amplitude, NoiseSource* noise) {
    const double share = amplitude / std::sqrt(static_cast<double>(frequencies.size()));
    for (const double frequency : frequencies) {
      const double strength = noise->normal(share);
      parts_.push_back({strength, frequency, noise->uniform(0.0, kTurn)});
    }
  }
  double at(double t) const {
    double sum = 0.0;
    for (const Part& part : parts_) {
      sum += part.amplitude * std::cos(kTurn * part.frequency * t + part.phase);
    }
    return sum;
  }

 private:
  struct Part {
    double amplitude;
    double frequency;  // Hz
    double phase;
  };
  std::vector<Part> parts_;
};

// Motion of a hand about the way its owner goes.
struct Hand {
  explicit Hand(NoiseSource* noise)
      : x({0.02, 0.035, 0.06, 0.1}, 0.9, noise),
        y({0.02, 0.035, 0.06, 0.1}, 0.6, noise),
        z({0.02, 0.035, 0.06, 0.1}, 0.35, noise),
        shake_x({0.7, 1.1, 1.6}, 0.006, noise),
        shake_y({0.7, 1.1, 1.6}, 0.006, noise),
        shake_z({0.7, 1.1, 1.6}, 0.006, noise),
        yaw({0.03, 0.05, 0.12}, 0.45, noise),
        pitch({0.04, 0.09}, 0.18, noise),
        roll({0.1, 0.3}, 0.05, noise) {}
  Wave x, y, z, shake_x, shake_y, shake_z, yaw, pitch, roll;
};

// Axes right, down, forward of a camera that looks along yaw and, downwards, pitch.
Eigen::Matrix3d orientation(double yaw, double pitch, double roll) {
  const Eigen::Vector3d forward(std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch),
                                -std::sin(pitch));
  const Eigen::Vector3d level(std::sin(yaw), -std::cos(yaw), 0.0);
  const Eigen::Vector3d right =
      std::cos(roll) * level + std::sin(roll) * Eigen::Vector3d(forward.cross(level));
  Eigen::Matrix3d R;
  R.col(0) = right;
  R.col(1) = forward.cross(right);
  R.col(2) = forward;
  return R;
}

RigidPose pose_at(WorldKind kind, const Hand& hand, double t) {
  Eigen::Vector3d position(hand.x.at(t), hand.y.at(t), hand.z.at(t));
  double yaw = hand.yaw.at(t);
  if (kind == WorldKind::kRoom) {
    const double angle = kTurn * t / kRoomRound;
    yaw = 0.6 * yaw + angle;
    position += 0.7 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  } else if (kind == WorldKind::kWalk) {
    const double angle = kTurn * kWalkSpeed * t / kWalkRound;
    position = 0.25 * position +
               Eigen::Vector3d(kWalkHalfX * std::cos(angle), kWalkHalfY * std::sin(angle), 0.0);
    yaw = 0.4 * yaw + std::atan2(kWalkHalfY * std::cos(angle), -kWalkHalfX * std::sin(angle));
  }
  position += Eigen::Vector3d(hand.shake_x.at(t), hand.shake_y.at(t), hand.shake_z.at(t));
  return {orientation(yaw, hand.pitch.at(t) + 0.15, hand.roll.at(t)), position};
}

}  // namespace

std::vector<RigidPose> camera_path(WorldKind kind, int32_t keyframes, NoiseSource* noise) {
  const Hand hand(noise);
  std::vector<RigidPose> path;
  path.reserve(static_cast<size_t>(keyframes));
  for (int32_t k = 0; k < keyframes; ++k) path.push_back(pose_at(kind, hand, k * kKeyframePeriod));
  return path;
}

}  // namespace unisim::simulator
