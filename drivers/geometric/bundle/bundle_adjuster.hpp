// SPDX-License-Identifier: MIT
// Levenberg-Marquardt on a BundleProblem: points eliminated, reduced camera system by Cholesky.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/geometric/bundle/bundle_problem.hpp"

namespace unisim::geometric {

class ReducedSystem;

/// How far and how a BundleAdjuster goes.
struct BundleOptions {
  int max_iterations = 10;  ///< linear solves, refused steps included
  double relative_tolerance =
      1e-4;                      ///< stop when an accepted step lowers the cost by less than this
  double pixel_scale = 1.0;      ///< residual = pixels / pixel_scale; image diagonal / 800
  double huber = 1.0;            ///< where the loss turns from square to linear, scaled pixels
  double initial_lambda = 1e-4;  ///< damping lambda diag(H) at the start
};

/// How a solve ended. The problem always holds the best state seen, at worst the one it came with.
enum class BundleStatus {
  kConverged,     ///< the last step lowered the cost by less than the tolerance
  kIterationCap,  ///< stopped at max_iterations, still improving
  kNoDescent,  ///< damping grew past its limit without a better state; the state is a local minimum
  kNothingToDo,   ///< no free unknown or no usable observation; state untouched
  kInvalidInput,  ///< a number is not finite or an option is out of range; state untouched
  kTooLarge,      ///< the problem exceeds the capacity the adjuster was built for; state untouched
};

/// What a solve did.
struct BundleResult {
  BundleStatus status = BundleStatus::kNothingToDo;
  int iterations = 0;
  double initial_cost = 0.0;  ///< robust, scaled pixels squared / 2, priors included
  double final_cost = 0.0;
  int observations = 0;  ///< used in the last linearisation
  double lambda = 0.0;   ///< damping at the end
};

/// What the last linearisation says about the precision of the unknowns.
struct BundlePrecision {
  bool valid = false;
  double center_sigma = 0.0;     ///< see BundleAdjuster::precision()
  double log_focal_sigma = 0.0;  ///< posterior standard deviation, prior included; 0 when held
  double log_focal_reach = 0.0;  ///< the same with what the model leaves out
  double k1_sigma = 0.0;         ///< posterior standard deviation, as log_focal_sigma
  double readout_sigma_s = 0.0;  ///< the same
  double residual_sigma =
      0.0;  ///< robust standard deviation of one residual component, scaled pixels
  double median_depth = 0.0;  ///< of the points in the chosen cameras
};

/// Bundle adjustment. Cost: sum of Huber(|r|) with r = weight / pixel_scale *
/// (f * (x / z, y / z) - undistorted pixel minus centre), plus priors. Points behind a camera cost
/// a large constant and pull on nothing; points with fewer than two usable observations are left as
/// they are.
///
/// Gauge: fixed cameras hold it. What they leave open is left to the damping: the step has no
/// component along it to first order, so the unit of the start survives; a caller who needs an
/// exact unit rescales afterwards. When none is fixed, all is moved back in the end so that the
/// first camera is where it was. To hold it during the solve would be to leave it behind where a
/// loop turns everything else by a large step: its observations then count as outliers.
///
/// Single thread; same problem, same bytes out. Nothing allocates after construction.
class BundleAdjuster {
 public:
  explicit BundleAdjuster(const BundleCapacity& capacity);
  ~BundleAdjuster();
  BundleAdjuster(const BundleAdjuster&) = delete;
  BundleAdjuster& operator=(const BundleAdjuster&) = delete;

  /// Lowers the cost of `problem` in place: free cameras, points, free intrinsics.
  BundleResult solve(BundleProblem* problem, const BundleOptions& options);

  /// Precision at the present state of `problem` (one linearisation, no damping, one
  /// factorisation).
  ///
  /// center_sigma: RMS standard deviation of the centres of `cameras` relative to the pose of
  /// cameras[count / 2], intrinsics taken as known, the change of scale of these centres projected
  /// out, times residual_sigma, over median_depth. Independent of the gauge the problem was solved
  /// in. log_focal_sigma and k1_sigma: posterior of the whole problem times residual_sigma; a freed
  /// intrinsic that the data do not see comes out at its prior sigma (or very large without prior).
  /// These take residuals for independent. What the model leaves out (of the lens, rows that are
  /// read one after the other, tracks that drift together) pushes all one way: log_focal_reach is
  /// how far the focal length can go for a hundredth of the cost, all else adjusted along.
  ///
  /// Cost: a factorisation, then 3 * count triangular solves; a window of a large map is best put
  /// into a problem of its own (1 ms for 16 cameras).
  ///
  /// @param cameras  camera indices in `problem`; fixed ones have no spread of their own
  /// @param count    3 or more; 0: only the intrinsics are asked for, center_sigma stays 0 and
  ///                 median_depth is that of all cameras
  /// @return valid = false when the system cannot be factorised or nothing is observed
  BundlePrecision precision(const BundleProblem& problem, const BundleOptions& options,
                            const std::int32_t* cameras, int count);

  std::size_t memory_bytes() const;  ///< held by the workspaces

 private:
  struct Workspace;
  class CenterMap;

  /// @param hold_first the first camera is fixed if no other is
  BundleStatus prepare(const BundleProblem& problem, const BundleOptions& options, bool hold_first);
  BundleStatus iterate(BundleProblem* problem, const BundleOptions& options, BundleResult* result);
  double center_variance(const CenterMap& map);
  void measure_residuals(const BundleProblem& problem, const BundleOptions& options,
                         const std::int32_t* cameras, int count, BundlePrecision* out);

  BundleCapacity capacity_;
  std::unique_ptr<ReducedSystem> system_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace unisim::geometric
