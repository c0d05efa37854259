// SPDX-License-Identifier: MIT
// A network as the bench simulates it, with places.
#include "tests/pipeline/walk_predictor.hpp"

#include <algorithm>
#include <cmath>

#include "tools/bench/simulator/c_structs.hpp"

namespace unisim::testing {
namespace {

using simulator::NoiseSource;
using simulator::RigidPose;

// The simulator's camera: 60 degrees wide, 46 high.
constexpr int32_t kImageWidth = 640;
constexpr int32_t kImageHeight = 470;
constexpr double kFocalPx = 554.3;
// Errors of one place against another, as in the bench's noise model.
constexpr double kTurn = 0.0087;  // rad
constexpr double kShift = 0.006;  // of the mean depth
constexpr double kDepthNoise = 0.03;
// Descriptors lose their likeness over so many metres, and over such a change of the direction.
constexpr double kReach = 0.5;
constexpr double kWide = 0.5;

int32_t stands_for(int32_t id, const WalkPredictor::Twin& twin) {
  return id >= twin.from && id < twin.to ? id - twin.back : id;
}

}  // namespace

WalkPredictor::WalkPredictor(const simulator::World& world, uint64_t seed)
    : world_(world), predictor_(world, seed), seed_(seed) {
  handle_.self = this;
  unisim_predictor& t = handle_.table;
  t.struct_size = sizeof t;
  t.name = "walk";
  t.observe = [](unisim_predictor*, const unisim_frame*, unisim_motion* motion) {
    *motion = {-1.0, -1.0, 0, 0};
    return UNISIM_PREDICTION_OK;
  };
  t.keyframe = [](unisim_predictor* p, const unisim_frame*, int32_t id) {
    return self(p)->keyframe(id);
  };
  t.two_view = [](unisim_predictor* p, int32_t i, int32_t j, unisim_pair_prediction* out) {
    return self(p)->two_view(i, j, out);
  };
  t.multi_view = [](unisim_predictor* p, const int32_t* ids, int32_t count,
                    unisim_window_prediction* out) { return self(p)->multi_view(ids, count, out); };
  t.info = [](unisim_predictor*, unisim_predictor_info* out) {
    *out = {};
    out->initialised = 1;
    out->focal_px = kFocalPx;
  };
  t.message = [](unisim_predictor*) { return "walk"; };
  t.window_message = t.message;
  t.destroy = [](unisim_predictor*) {};
  t.place_descriptor = [](unisim_predictor* p, int32_t id, unisim_place_descriptor* out) {
    return self(p)->describe(id, out);
  };
  t.release_place = [](unisim_predictor* p, int32_t id) { self(p)->release(id); };
}

WalkPredictor* WalkPredictor::self(unisim_predictor* predictor) {
  return reinterpret_cast<Handle*>(predictor)->self;
}

int WalkPredictor::keyframe(int32_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_ = id;
  return UNISIM_PREDICTION_OK;
}

int WalkPredictor::two_view(int32_t i, int32_t, unisim_pair_prediction* out) {
  fill(predictor_.pair(i), &pair_);
  *out = {};
  out->T_i_j = pair_.poses[1];
  out->depth_i = pair_.maps[0];
  out->depth_j = pair_.maps[1];
  out->focal_px = kFocalPx;
  return UNISIM_PREDICTION_OK;
}

int WalkPredictor::multi_view(const int32_t* ids, int32_t count, unisim_window_prediction* out) {
  const std::vector<int32_t> asked(ids, ids + count);
  if (asked.back() - asked.front() == count - 1) {
    fill(predictor_.window(asked.front(), count), &window_);
  } else {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++distant_asked_;
      for (const int32_t id : asked) astray_ += places_.count(id) == 0 ? 1 : 0;
    }
    fill(distant(asked), &window_);
  }
  *out = {};
  out->count = count;
  out->keyframe_ids = window_.ids.data();
  out->T_window_kf = window_.poses.data();
  out->depth = window_.maps.data();
  out->focal_px = kFocalPx;
  return UNISIM_PREDICTION_OK;
}

/// Keyframes of two places. A network that takes one place for another sees it at the other's depth
/// as long as it has only two views of it.
simulator::Prediction WalkPredictor::distant(const std::vector<int32_t>& ids) const {
  const auto first = static_cast<uint64_t>(ids.front());
  NoiseSource noise(
      synth::derive_seed(synth::derive_seed(seed_, first), static_cast<uint64_t>(ids.back())));
  const double depth_scale = world_.mean_depth[static_cast<size_t>(ids.front())];
  const RigidPose error{simulator::rotation(noise.normal3(kTurn)),
                        noise.normal3(kShift * depth_scale)};
  const double unit = std::exp(noise.normal(0.05));
  const auto pose = [&](int32_t id) {
    return world_.T_world_kf[static_cast<size_t>(stands_for(id, lie))];
  };
  simulator::Prediction out;
  out.keyframes = ids;
  for (const int32_t id : ids) {
    RigidPose T = pose(ids.front()).inverse() * pose(id);
    if (id - ids.front() > (ids.back() - ids.front()) / 2) T = error * T;
    T.t *= unit;
    out.T_local_kf.push_back(T);
    const int32_t seen = ids.size() == 2 ? stands_for(id, lie) : id;
    simulator::DepthMap depth = world_.depth[static_cast<size_t>(seen)];
    for (float& d : depth) d *= static_cast<float>(unit * (1.0 + noise.normal(kDepthNoise)));
    out.depth.push_back(depth);
  }
  return out;
}

void WalkPredictor::fill(const simulator::Prediction& prediction, Arrays* arrays) const {
  arrays->ids = prediction.keyframes;
  arrays->depths = prediction.depth;
  arrays->poses.clear();
  arrays->maps.clear();
  for (const RigidPose& pose : prediction.T_local_kf)
    arrays->poses.push_back(simulator::to_c(pose));
  for (const simulator::DepthMap& depth : arrays->depths) {
    arrays->maps.push_back(simulator::to_c(depth));
  }
}

/// Waves over place and direction: near ones have them alike.
int WalkPredictor::describe(int32_t id, unisim_place_descriptor* out) {
  const std::lock_guard<std::mutex> lock(mutex_);
  astray_ += id == newest_ ? 0 : 1;
  places_.insert(id);
  most_kept_ = std::max(most_kept_, static_cast<int32_t>(places_.size()));
  const auto shown = static_cast<size_t>(stands_for(stands_for(id, look), lie));
  const RigidPose& pose = world_.T_world_kf[shown];
  NoiseSource waves(7);
  const auto wanted = wrong_size.find(id);
  descriptor_.resize(wanted != wrong_size.end() ? static_cast<size_t>(wanted->second)
                                                : static_cast<size_t>(kDimension));
  for (int8_t& value : descriptor_) {
    const double phase = waves.normal3(1.0 / kReach).dot(pose.t) +
                         waves.normal3(1.0 / kWide).dot(pose.R.col(2)) + waves.uniform(0.0, 6.3);
    value = static_cast<int8_t>(std::lround(40.0 * std::cos(phase)));
    if (blank.count(id) != 0) value = 0;
  }
  *out = {descriptor_.data(), static_cast<int32_t>(descriptor_.size()), kImageWidth, kImageHeight,
          0};
  return UNISIM_PREDICTION_OK;
}

void WalkPredictor::release(int32_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (places_.erase(id) == 0) ++astray_;
}

int32_t WalkPredictor::kept() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int32_t>(places_.size());
}

int32_t WalkPredictor::most_kept() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return most_kept_;
}

int32_t WalkPredictor::calls_astray() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return astray_;
}

int64_t WalkPredictor::distant_asked() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return distant_asked_;
}

}  // namespace unisim::testing
