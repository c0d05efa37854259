// SPDX-License-Identifier: MIT
// Simulated feed-forward predictor.
#include "tools/bench/simulator/predictor.hpp"

#include <cmath>
#include <cstdlib>
#include <numeric>

namespace unisim::simulator {
namespace {

using Eigen::Vector3d;

constexpr double kRadians = 0.017453292519943295;
constexpr double kLeastDepth = 1e-3;
constexpr double kFalseTurn = 5.0;    // degrees that a false loop is off its claim
constexpr double kFalseShift = 0.15;  // and metres

// Kinds of items, for their seeds.
enum : uint64_t { kPairItem = 16, kWindowItem, kLoopItem };

uint64_t item_seed(uint64_t seed, uint64_t kind, int32_t a, int32_t b) {
  const uint64_t item =
      synth::derive_seed(synth::derive_seed(seed, kind), static_cast<uint64_t>(a));
  return synth::derive_seed(item, static_cast<uint64_t>(b));
}

// Views in the order of time on both sides of their centre: errors grow away from it.
struct Side {
  int32_t first;
  int32_t end;
  int32_t center;
};

std::vector<Vector3d> random_walk(int32_t count, const std::vector<Side>& sides, double sigma,
                                  NoiseSource* noise) {
  std::vector<Vector3d> walk(static_cast<size_t>(count), Vector3d::Zero());
  for (const Side& side : sides) {
    for (int32_t k = side.center + 1; k < side.end; ++k) {
      walk[static_cast<size_t>(k)] = walk[static_cast<size_t>(k - 1)] + noise->normal3(sigma);
    }
    for (int32_t k = side.center - 1; k >= side.first; --k) {
      walk[static_cast<size_t>(k)] = walk[static_cast<size_t>(k + 1)] + noise->normal3(sigma);
    }
  }
  return walk;
}

// Error of the second place of a loop against the first, seen from its own centre view.
RigidPose loop_error(const NoiseModel& model, double mean_depth, NoiseSource* noise) {
  return {rotation(noise->normal3(model.scale * model.loop_rotation * kRadians)),
          noise->normal3(model.scale * model.loop_translation * mean_depth)};
}

// The first half of a loop prediction belongs to the match, the second to the query, whose view
// `origin` is the frame. Moves the match's half.
void move_match(const Loop& loop, const NoiseModel& model, int32_t origin, double unit,
                double mean_depth, NoiseSource* noise, std::vector<RigidPose>* T) {
  const size_t center = kLoopHalf / 2;
  RigidPose error = loop_error(model, mean_depth, noise);
  error.t *= unit;
  const RigidPose T_center = (*T)[center];
  RigidPose move = T_center * error * T_center.inverse();
  if (loop.is_false) {
    const RigidPose claim{rotation(noise->normal3(kFalseTurn * kRadians)),
                          noise->normal3(unit * kFalseShift)};
    move = (*T)[static_cast<size_t>(origin)] * claim * T_center.inverse();
  }
  for (size_t k = 0; k < kLoopHalf; ++k) (*T)[k] = move * (*T)[k];
}

}  // namespace

Predictor::Predictor(const World& world, uint64_t seed, const NoiseModel& model)
    : world_(world), seed_(seed), model_(model) {}

double Predictor::unit(const std::vector<int32_t>& keyframes, double sigma,
                       NoiseSource* noise) const {
  double mean_depth = 0.0;
  for (const int32_t k : keyframes) mean_depth += world_.mean_depth[static_cast<size_t>(k)];
  mean_depth /= static_cast<double>(keyframes.size());
  return std::exp(-model_.unit_content * std::log(mean_depth) + noise->normal(sigma));
}

DepthMap Predictor::observe(int32_t keyframe, double log_scale, NoiseSource* noise) const {
  const double tilt_x = noise->normal(model_.tilt);
  const double tilt_y = noise->normal(model_.tilt);
  const DepthMap& truth = world_.depth[static_cast<size_t>(keyframe)];
  DepthMap seen;
  for (int32_t pixel = 0; pixel < kDepthPixels; ++pixel) {
    const Eigen::Vector2d at = image_position(pixel);
    double depth = truth[static_cast<size_t>(pixel)] *
                   std::exp(log_scale + tilt_x * at.x() + tilt_y * at.y()) *
                   (1.0 + noise->normal(model_.pixel));
    if (noise->uniform(0.0, 1.0) < model_.outlier_share) {
      depth *= std::exp(noise->normal(model_.outlier));
    }
    if (model_.holes > 0.0 && noise->uniform(0.0, 1.0) < model_.holes) depth = 0.0;
    seen[static_cast<size_t>(pixel)] = depth > kLeastDepth ? static_cast<float>(depth) : 0.0F;
  }
  return seen;
}

Prediction Predictor::pair(int32_t i) const {
  NoiseSource noise(item_seed(seed_, kPairItem, i, 0));
  Prediction prediction;
  prediction.keyframes = {i, i + 1};
  const double lambda = unit(prediction.keyframes, model_.unit_pair, &noise);
  const size_t at = static_cast<size_t>(i);
  const RigidPose truth = world_.T_world_kf[at].inverse() * world_.T_world_kf[at + 1];
  const Eigen::AngleAxisd turn(truth.R);
  const double angle = turn.angle() * (1.0 + noise.normal(model_.scale * model_.pair_turn));
  RigidPose T_i_j;
  T_i_j.R = rotation(turn.axis() * angle) *
            rotation(noise.normal3(model_.scale * model_.pair_rotation * kRadians));
  T_i_j.t = truth.t * std::exp(noise.normal(model_.scale * model_.pair_baseline)) +
            noise.normal3(model_.scale * model_.pair_translation * world_.mean_depth[at]);
  T_i_j.t *= lambda;
  prediction.T_local_kf = {RigidPose(), T_i_j};
  for (const int32_t k : prediction.keyframes) {
    const double view = noise.normal(model_.pair_view);
    prediction.depth.push_back(observe(k, std::log(lambda) + view, &noise));
  }
  return prediction;
}

Prediction Predictor::window(int32_t first, int32_t count) const {
  NoiseSource noise(item_seed(seed_, kWindowItem, first, count));
  std::vector<int32_t> keyframes(static_cast<size_t>(count));
  std::iota(keyframes.begin(), keyframes.end(), first);
  return infer(keyframes, count / 2, nullptr, &noise);
}

Prediction Predictor::loop(const Loop& loop) const {
  NoiseSource noise(item_seed(seed_, kLoopItem, loop.query, loop.match));
  const int32_t query = Loop::first_around(loop.query, world_.keyframes());
  std::vector<int32_t> keyframes(2 * kLoopHalf);
  const auto middle = keyframes.begin() + kLoopHalf;
  std::iota(keyframes.begin(), middle, Loop::first_around(loop.match, world_.keyframes()));
  std::iota(middle, keyframes.end(), query);
  return infer(keyframes, kLoopHalf + loop.query - query, &loop, &noise);
}

Prediction Predictor::infer(const std::vector<int32_t>& keyframes, int32_t origin, const Loop* loop,
                            NoiseSource* noise) const {
  const int32_t count = static_cast<int32_t>(keyframes.size());
  const double scale = model_.scale;
  const double lambda = unit(keyframes, model_.unit_window, noise);
  const RigidPose& T_world_origin =
      world_.T_world_kf[static_cast<size_t>(keyframes[static_cast<size_t>(origin)])];
  const double mean_depth =
      world_.mean_depth[static_cast<size_t>(keyframes[static_cast<size_t>(origin)])];
  std::vector<Side> sides{{0, count, origin}};
  if (loop != nullptr) {
    sides = {{0, kLoopHalf, kLoopHalf / 2}, {kLoopHalf, count, kLoopHalf + kLoopHalf / 2}};
  }
  const double drift = noise->normal(scale * model_.window_drift);
  const double baseline = noise->normal(scale * model_.window_baseline);
  const std::vector<Vector3d> turn =
      random_walk(count, sides, scale * model_.window_rotation_walk * kRadians, noise);
  const std::vector<Vector3d> shift =
      random_walk(count, sides, scale * model_.window_translation_walk * mean_depth, noise);
  const double match_scale = loop != nullptr ? noise->normal(scale * model_.loop_scale) : 0.0;

  Prediction prediction;
  prediction.keyframes = keyframes;
  for (const Side& side : sides) {
    for (int32_t k = side.first; k < side.end; ++k) {
      const size_t at = static_cast<size_t>(k);
      const double away = std::abs(k - side.center) / 8.0;
      const double beta = (k >= origin ? drift : -drift) * away;
      RigidPose T =
          T_world_origin.inverse() * world_.T_world_kf[static_cast<size_t>(keyframes[at])];
      T.R = T.R * rotation(turn[at] + noise->normal3(scale * model_.window_rotation * kRadians));
      T.t = T.t * std::exp(baseline + beta) + shift[at] +
            noise->normal3(scale * model_.window_translation * mean_depth);
      T.t *= lambda;
      prediction.T_local_kf.push_back(T);
      const bool of_match = loop != nullptr && k < kLoopHalf;
      const double view =
          beta + noise->normal(scale * model_.window_view) + (of_match ? match_scale : 0.0);
      prediction.depth.push_back(observe(keyframes[at], std::log(lambda) + view, noise));
    }
  }
  if (loop != nullptr) {
    move_match(*loop, model_, origin, lambda, mean_depth, noise, &prediction.T_local_kf);
  }
  return prediction;
}

}  // namespace unisim::simulator
