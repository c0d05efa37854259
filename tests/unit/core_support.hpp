// SPDX-License-Identifier: MIT
// What the tests of core share: objects carved from an arena, random values, comparison.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "core/base/arena.hpp"
#include "core/graph/graph.hpp"
#include "core/lie/sim3.hpp"
#include "core/solve/lm.hpp"
#include "core/solve/order/block_map.hpp"

namespace unisim_test {

inline const double kPi = std::acos(-1.0);
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Object whose constructor is T(Arena&, capacity), with memory of exactly the size the dry run
/// says.
template <class T, class Capacity>
class Carved {
 public:
  explicit Carved(const Capacity& capacity) {
    unisim::Arena dry;
    T counted(dry, capacity);
    memory_.resize(dry.required_bytes());
    unisim::Arena arena(memory_.data(), memory_.size());
    object_ = T(arena, capacity);
    fits_ = arena.ok();
  }
  Carved(const Carved&) = delete;
  Carved& operator=(const Carved&) = delete;

  T& operator*() { return object_; }
  T* operator->() { return &object_; }
  bool fits() const { return fits_; }

 private:
  std::vector<unsigned char> memory_;
  T object_;
  bool fits_ = false;
};
using CarvedGraph = Carved<unisim::Graph, unisim::GraphCapacity>;
using CarvedLm = Carved<unisim::LevenbergMarquardt, unisim::SolverCapacity>;

/// Same numbers on every platform, unlike the standard distributions.
class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
  }
  int32_t below(int32_t end) {
    return static_cast<int32_t>(engine_() % static_cast<uint32_t>(end));
  }
  unisim::Vec3 vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  unisim::Vec3 direction() {
    for (;;) {
      const unisim::Vec3 v = vector(1.0);
      if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
    }
  }
  /// Tangent with the given rotation angle [rad] and log-scale.
  unisim::Vec7 tangent(double length, double angle, double log_scale) {
    unisim::Vec7 xi;
    xi << vector(length), angle * direction(), log_scale;
    return xi;
  }
  unisim::Sim3 pose(double length, double angle, double log_scale) {
    return unisim::sim3_exp(tangent(length, uniform(0.0, angle), uniform(-log_scale, log_scale)));
  }

 private:
  std::mt19937 engine_;
};

/// Largest difference of entries.
template <class A, class B>
double difference(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// Largest difference of the 4x4 matrices [sR t; 0 1].
inline double difference(const unisim::Sim3& a, const unisim::Sim3& b) {
  const unisim::Mat3 sR_a = a.s * a.q.toRotationMatrix();
  const unisim::Mat3 sR_b = b.s * b.q.toRotationMatrix();
  return std::max(difference(sR_a, sR_b), difference(a.t, b.t));
}

/// Jacobian of f at T for right perturbations, by five-point central differences.
template <class Function>
Eigen::MatrixXd numeric_jacobian(const unisim::Sim3& T, Function f) {
  constexpr double kStep = 1e-3;
  const Eigen::VectorXd at = f(T);
  Eigen::MatrixXd J(at.size(), 7);
  for (int k = 0; k < 7; ++k) {
    const auto moved = [&](double step) -> Eigen::VectorXd {
      unisim::Vec7 dx = unisim::Vec7::Zero();
      dx(k) = step;
      return f(unisim::retract(T, dx));
    };
    J.col(k) = (8.0 * (moved(kStep) - moved(-kStep)) - (moved(2 * kStep) - moved(-2 * kStep))) /
               (12.0 * kStep);
  }
  return J;
}

/// H as a NormalEquations puts it together, in memory of its own: every column is wanted.
class Assembled {
 public:
  Assembled(unisim::NormalEquations& equations, const unisim::Graph& graph,
            const unisim::BlockPattern& pattern)
      : columns_(pattern.columns()),
        start_(pattern.column_start().begin(), pattern.column_start().end()),
        rows_(pattern.rows().begin(), pattern.rows().end()),
        blocks_(static_cast<size_t>(columns_) + rows_.size()),
        state_(static_cast<size_t>(columns_), unisim::ColumnState::kOpen),
        place_(blocks_.size()) {
    std::iota(place_.begin(), place_.end(), 0);
    equations.mark_all_changed();
    cost_ = equations.linearize(graph, pattern,
                                {unisim::Supernodes(), blocks_.data(), place_.data(),
                                 place_.data() + columns_, state_.data()},
                                false);
  }
  double cost() const { return cost_; }
  int32_t columns() const { return columns_; }
  /// The whole of H.
  Eigen::MatrixXd dense() const {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(7 * columns_, 7 * columns_);
    for (int32_t j = 0; j < columns_; ++j) {
      const size_t column = static_cast<size_t>(j);
      H.block<7, 7>(7 * j, 7 * j) = unisim::as_matrix(blocks_[column]);
      for (int32_t p = start_[column]; p < start_[column + 1]; ++p) {
        H.block<7, 7>(7 * rows_[static_cast<size_t>(p)], 7 * j) =
            unisim::as_matrix(blocks_[static_cast<size_t>(columns_ + p)]);
      }
    }
    return H.selfadjointView<Eigen::Lower>();
  }
  /// Put H where a factorisation wants it.
  void copy_to(unisim::BlockCholesky& cholesky) const {
    cholesky.mark_all_stale();
    copy_stale_to(cholesky);
  }
  /// The same for stale columns only.
  void copy_stale_to(unisim::BlockCholesky& cholesky) const {
    const unisim::Assembly target = cholesky.begin_assembly();
    for (int32_t j = 0; j < columns_; ++j) {
      if (!target.wants(j)) continue;
      target.open(j);
      target.blocks[target.diagonal[j]] = blocks_[static_cast<size_t>(j)];
      for (int32_t p = start_[static_cast<size_t>(j)]; p < start_[static_cast<size_t>(j) + 1];
           ++p) {
        target.blocks[target.off_diagonal[p]] = blocks_[static_cast<size_t>(columns_ + p)];
      }
    }
  }
  unisim::Block& diagonal(int32_t column) { return blocks_[static_cast<size_t>(column)]; }

 private:
  int32_t columns_;
  std::vector<int32_t> start_;
  std::vector<int32_t> rows_;
  std::vector<unisim::Block> blocks_;
  std::vector<unisim::ColumnState> state_;
  std::vector<int32_t> place_;
  double cost_ = 0.0;
};

/// Rotation by an angle [rad] about z, then translation; scale s.
inline unisim::Sim3 about_z(double angle, double x, double y, double z, double s) {
  unisim::Sim3 T;
  T.q = unisim::Quat(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle));
  T.t << x, y, z;
  T.s = s;
  return T;
}

}  // namespace unisim_test
