// SPDX-License-Identifier: MIT
// Covariances of keyframe poses.
#include <algorithm>

#include "core/session.hpp"

namespace unisim {
namespace {

/// y += factor M x, or M' x; x every `step` numbers. Loops: unrolled products of fixed size make
/// the library kilobytes larger.
void add_product(double factor, const Mat7& M, bool transposed, const double* x, int step,
                 double* y) {
  for (int row = 0; row < kTangentDim; ++row) {
    double sum = 0.0;
    for (int k = 0; k < kTangentDim; ++k) sum += (transposed ? M(k, row) : M(row, k)) * x[k * step];
    y[row] += factor * sum;
  }
}

}  // namespace

/// Node that carries a keyframe, -1 without a pose of its own.
int32_t Session::carrier(const Keyframe& keyframe) const {
  return keyframe.retired() ? map_.submaps[keyframe.owner].place.node : keyframe.node;
}

/// What a move of its carrier is for the keyframe: T = S X and S exp(d) X = S X exp(Ad(X^-1) d).
Mat7 Session::carried(const Keyframe& keyframe) const {
  Sim3 X;
  if (keyframe.retired())
    X = (map_.submaps[keyframe.owner].place.T_node_submap * keyframe.T_owner_kf).inverse();
  return sim3_adjoint(X);
}

/// How far a retired keyframe may be off in its submap, whose pose carries it: each window over it
/// measured it once. Keyframes in the graph have that in their edges.
double Session::own_variance(const Keyframe& keyframe) const {
  if (!keyframe.retired()) return 0.0;
  const double multiplier = map_.submaps[keyframe.owner].quality.multiplier;
  return variance_factor_ / (multiplier * std::max<int32_t>(keyframe.window_count, 1));
}

/// Of an edge with full weight, as far as the predictor says how sure it is. Windows may be cut
/// from one map and share most of what they saw: that they agree does not make them right, and what
/// several of them say of a keyframe was measured once.
double Session::told_variance() const {
  double sum = 0.0;
  int32_t windows = 0;
  for (int32_t k = 0; k < map_.submaps.size(); ++k) {
    const Submap& window = map_.submaps.at(k);
    const double sigma = std::min(window.quality.center_sigma, map_.config.sigma_reference);
    if (window.is_loop || window.place.node < 0 || sigma <= 0.0) continue;
    sum += sigma * sigma;
    ++windows;
  }
  const SessionConfig& config = map_.config;
  const double times_told = static_cast<double>(config.window_size) /
                            static_cast<double>(config.window_size - config.window_overlap);
  const double factor = config.sigma_factor * config.sigma_factor * times_told;
  return windows > 0 ? factor * sum / windows : 0.0;
}

Status Session::covariance(int32_t keyframe, Mat7* covariance) {
  if (map_.keyframes.gone(keyframe)) return Status::kRetired;
  if (!map_.keyframes.has(keyframe)) return Status::kInvalidArgument;
  const Keyframe& asked = map_.keyframes[keyframe];
  const int32_t node = carrier(asked);
  if (node < 0 || map_.graph.revision() != solved_revision_) return Status::kNotReady;
  if (map_.graph.node(node).fixed) {
    covariance->setZero();
  } else {
    const Status status = solver_.marginal_covariance(map_.graph, node, covariance);
    if (!is_ok(status)) return status;
  }
  const Mat7 Ad = carried(asked);
  double out[kTangentDim * kTangentDim] = {};  // Ad C Ad'
  for (int k = 0; k < kTangentDim; ++k) {
    double column[kTangentDim] = {};
    add_product(variance_factor_, *covariance, false, Ad.data() + k, kTangentDim, column);
    add_product(1.0, Ad, false, column, 1, out + kTangentDim * k);
    out[(kTangentDim + 1) * k] += own_variance(asked);
  }
  std::copy_n(out, kTangentDim * kTangentDim, covariance->data());
  return Status::kOk;
}

Status Session::multiply_covariance(int32_t first, int32_t count, const double* weights,
                                    double* products) {
  if (map_.keyframes.gone(first)) return Status::kRetired;
  if (count < 1 || !map_.keyframes.has(first) || count > map_.keyframes.size() - first) {
    return Status::kInvalidArgument;
  }
  if (map_.graph.revision() != solved_revision_) return Status::kNotReady;
  Span<BlockVector> x;
  const Status status = solver_.begin_product(map_.graph, &x);
  if (!is_ok(status)) return status;
  const auto column_of = [&](const Keyframe& keyframe) {
    const int32_t node = carrier(keyframe);
    return node < 0 ? -1 : solver_.pattern().column_of_node(node);
  };
  for (int32_t k = 0; k < count; ++k) {
    const Keyframe& keyframe = map_.keyframes[first + k];
    const int32_t column = column_of(keyframe);
    if (column < 0) continue;
    add_product(1.0, carried(keyframe), true, weights + kTangentDim * k, 1, x[column].v);
  }
  solver_.finish_product(x);
  for (int32_t k = 0; k < count; ++k) {
    const Keyframe& keyframe = map_.keyframes[first + k];
    const int32_t column = column_of(keyframe);
    double* product = products + kTangentDim * k;
    const double own = own_variance(keyframe);
    for (int d = 0; d < kTangentDim; ++d) product[d] = own * weights[kTangentDim * k + d];
    if (column >= 0)
      add_product(variance_factor_, carried(keyframe), false, x[column].v, 1, product);
  }
  return Status::kOk;
}

}  // namespace unisim
