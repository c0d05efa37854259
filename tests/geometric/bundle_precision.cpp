// SPDX-License-Identifier: MIT
// Predicted precision against the covariance of a dense, numerically differentiated problem.
#include <Eigen/Dense>

#include "drivers/geometric/bundle/bundle_adjuster.hpp"
#include "drivers/geometric/bundle/robust_cost.hpp"
#include "tests/geometric/bundle_scene.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::geometric;

namespace {

constexpr double kDifference = 1e-5;

// Unknowns in order: 6 per free camera, 3 per point, log f, k1.
struct Dense {
  BundleProblem problem;
  int fixed;

  int camera_size() const { return 6 * (problem.camera_count() - fixed); }
  int geometry_size() const { return camera_size() + 3 * problem.point_count(); }
  int size() const { return geometry_size() + 2; }

  BundleProblem moved(int unknown, double h) const {
    BundleProblem to = problem;
    if (unknown < camera_size()) {
      CameraPose& pose = to.camera(fixed + unknown / 6).pose;
      pose = retract(pose, h * Eigen::Matrix<double, 6, 1>::Unit(unknown % 6));
    } else if (unknown < geometry_size()) {
      const int k = unknown - camera_size();
      to.point(k / 3).position[k % 3] += h;
    } else if (unknown == geometry_size()) {
      to.intrinsics.log_focal += h;
    } else {
      to.intrinsics.k1 += h;
    }
    return to;
  }

  static Eigen::VectorXd residuals(const BundleProblem& at) {
    const ResidualIntrinsics constants = residual_intrinsics(at.intrinsics, 1.0);
    Eigen::VectorXd r(2 * at.observation_count());
    for (int p = 0; p < at.point_count(); ++p) {
      for (int o = at.point(p).first; o < at.point(p).first + at.point(p).count; ++o) {
        const BundleObservation& seen = at.observation(o);
        r.segment<2>(2 * o) = reprojection_value(
            constants, at.camera(seen.camera).pose.apply(at.point(p).position), seen);
      }
    }
    return r;
  }

  Eigen::MatrixXd information() const {
    Eigen::MatrixXd J(2 * problem.observation_count(), size());
    for (int k = 0; k < size(); ++k) {
      J.col(k) = (residuals(moved(k, kDifference)) - residuals(moved(k, -kDifference))) /
                 (2.0 * kDifference);
    }
    Eigen::MatrixXd H = J.transpose() * J;
    const double focal_sigma = problem.intrinsics.log_focal_sigma;
    const double k1_sigma = problem.intrinsics.k1_sigma;
    if (focal_sigma > 0.0) H(size() - 2, size() - 2) += 1.0 / (focal_sigma * focal_sigma);
    if (k1_sigma > 0.0) H(size() - 1, size() - 1) += 1.0 / (k1_sigma * k1_sigma);
    return H;
  }

  // Centres of `cameras` in the frame of the middle one.
  static Eigen::VectorXd centers(const BundleProblem& at,
                                 const std::vector<std::int32_t>& cameras) {
    Eigen::VectorXd all(3 * static_cast<Eigen::Index>(cameras.size()));
    const CameraPose& reference = at.camera(cameras[cameras.size() / 2]).pose;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      all.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          reference.apply(at.camera(cameras[i]).pose.center());
    }
    return all;
  }
};

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& H) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H);
  Eigen::VectorXd inverse = eigen.eigenvalues();
  const double floor = 1e-9 * inverse.maxCoeff();
  for (int i = 0; i < inverse.size(); ++i) inverse[i] = inverse[i] > floor ? 1.0 / inverse[i] : 0.0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

Dense small_problem(int fixed) {
  bundle_scene::Options options;
  options.cameras = 7;
  options.points = 40;
  options.noise_px = 0.2;
  const bundle_scene::Scene scene = bundle_scene::make(options);
  Dense dense{BundleProblem(bundle_scene::capacity(scene)), fixed};
  bundle_scene::fill(scene, fixed, &dense.problem);
  dense.problem.intrinsics.free_focal = true;
  dense.problem.intrinsics.free_k1 = true;
  dense.problem.intrinsics.k1_sigma = 0.02;
  return dense;
}

BundleOptions square_loss() {
  BundleOptions options;
  options.huber = 1e6;
  options.max_iterations = 20;
  return options;
}

}  // namespace

TEST_CASE("center_sigma agrees with a dense covariance") {
  const int fixed = GENERATE(1, 3);
  const std::vector<std::int32_t> cameras = GENERATE(std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6},
                                                     std::vector<std::int32_t>{2, 4, 5, 6});
  CAPTURE(fixed, cameras.size());
  Dense dense = small_problem(fixed);
  BundleAdjuster adjuster(dense.problem.capacity());
  adjuster.solve(&dense.problem, square_loss());
  const BundlePrecision precision = adjuster.precision(dense.problem, square_loss(), cameras.data(),
                                                       static_cast<int>(cameras.size()));
  REQUIRE(precision.valid);

  const int n = dense.geometry_size();
  const Eigen::MatrixXd covariance = pseudo_inverse(dense.information().topLeftCorner(n, n));
  Eigen::MatrixXd A(3 * static_cast<Eigen::Index>(cameras.size()), n);
  for (int k = 0; k < n; ++k) {
    A.col(k) = (Dense::centers(dense.moved(k, kDifference), cameras) -
                Dense::centers(dense.moved(k, -kDifference), cameras)) /
               (2.0 * kDifference);
  }
  const Eigen::VectorXd s = Dense::centers(dense.problem, cameras).normalized();
  A -= s * (s.transpose() * A);
  const double variance =
      (A * covariance * A.transpose()).trace() / static_cast<double>(cameras.size() - 1);
  const double expected = std::sqrt(variance) * precision.residual_sigma / precision.median_depth;
  REQUIRE(precision.center_sigma == Approx(expected).epsilon(1e-3));
}

TEST_CASE("posterior of the intrinsics agrees with a dense covariance") {
  Dense dense = small_problem(1);
  const bool k1_free = GENERATE(true, false);
  CAPTURE(k1_free);
  dense.problem.intrinsics.free_k1 = k1_free;
  BundleAdjuster adjuster(dense.problem.capacity());
  adjuster.solve(&dense.problem, square_loss());
  const BundlePrecision precision = adjuster.precision(dense.problem, square_loss(), nullptr, 0);
  REQUIRE(precision.valid);
  const int n = dense.size() - (k1_free ? 0 : 1);
  const Eigen::MatrixXd covariance = pseudo_inverse(dense.information().topLeftCorner(n, n));
  const int focal = dense.size() - 2;
  REQUIRE(precision.log_focal_sigma ==
          Approx(std::sqrt(covariance(focal, focal)) * precision.residual_sigma).epsilon(1e-3));
  const double k1 = k1_free ? std::sqrt(covariance(focal + 1, focal + 1)) : 0.0;
  REQUIRE(precision.k1_sigma == Approx(k1 * precision.residual_sigma).epsilon(1e-3));
}

namespace {

BundlePrecision adjusted_precision(bool slides, double focal_prior) {
  bundle_scene::Options options;
  options.cameras = 12;
  options.points = 200;
  options.noise_px = 0.3;
  options.slides_along_wall = slides;
  const bundle_scene::Scene scene = bundle_scene::make(options);
  BundleProblem problem(bundle_scene::capacity(scene));
  bundle_scene::fill(scene, 1, &problem);
  problem.intrinsics.free_focal = true;
  problem.intrinsics.log_focal_mean = problem.intrinsics.log_focal;
  problem.intrinsics.log_focal_sigma = focal_prior;
  BundleAdjuster adjuster(problem.capacity());
  adjuster.solve(&problem, BundleOptions{});
  return adjuster.precision(problem, BundleOptions{}, nullptr, 0);
}

}  // namespace

TEST_CASE("a camera that turns among things tells how long its focal length is") {
  const BundlePrecision precision = adjusted_precision(false, 0.0);
  REQUIRE(precision.valid);
  CHECK(precision.log_focal_reach > precision.log_focal_sigma);
  CHECK(precision.log_focal_reach < 0.05);
}

TEST_CASE("one that slides along a wall does not, and knows it") {
  const BundlePrecision precision = adjusted_precision(true, 0.0);
  REQUIRE(precision.valid);
  CHECK(precision.log_focal_reach > 1.0);
}

TEST_CASE("what is only believed of a focal length stays as uncertain as it was believed") {
  const BundlePrecision precision = adjusted_precision(true, 0.3);
  REQUIRE(precision.valid);
  CHECK(precision.log_focal_reach == Approx(0.3).epsilon(0.1));
}

TEST_CASE("residual_sigma is the noise of the pixels, outliers or not") {
  bundle_scene::Options options;
  options.noise_px = 0.7;
  options.outlier_share = 0.03;
  const bundle_scene::Scene scene = bundle_scene::make(options);
  BundleProblem problem(bundle_scene::capacity(scene));
  bundle_scene::fill(scene, 1, &problem);
  BundleAdjuster adjuster(problem.capacity());
  adjuster.solve(&problem, BundleOptions());
  const std::int32_t cameras[] = {0, 5, 10, 15};
  const BundlePrecision precision = adjuster.precision(problem, BundleOptions(), cameras, 4);
  REQUIRE(precision.residual_sigma == Approx(0.7).epsilon(0.1));
  REQUIRE(precision.median_depth == Approx(2.2).epsilon(0.15));
}

TEST_CASE("center_sigma does not depend on which camera holds the gauge") {
  bundle_scene::Options options;
  options.noise_px = 0.3;
  const bundle_scene::Scene scene = bundle_scene::make(options);
  BundleProblem problem(bundle_scene::capacity(scene));
  BundleAdjuster adjuster(problem.capacity());
  const std::int32_t cameras[] = {4, 6, 8, 10, 12};
  double sigma[2];
  for (int i = 0; i < 2; ++i) {
    bundle_scene::fill(scene, 0, &problem);
    problem.camera(i == 0 ? 0 : 8).fixed = true;
    const BundlePrecision precision = adjuster.precision(problem, BundleOptions(), cameras, 5);
    REQUIRE(precision.valid);
    sigma[i] = precision.center_sigma;
  }
  REQUIRE(sigma[0] == Approx(sigma[1]).epsilon(1e-4));
}

TEST_CASE("precision of nothing is not valid") {
  BundleProblem problem({3, 3, 4, 8});
  for (int i = 0; i < 3; ++i) problem.add_camera(CameraPose(), false);
  BundleAdjuster adjuster(problem.capacity());
  const std::int32_t cameras[] = {0, 1, 2};
  const std::int32_t unknown[] = {0, 1, 9};
  REQUIRE_FALSE(adjuster.precision(problem, BundleOptions(), cameras, 3).valid);
  REQUIRE_FALSE(adjuster.precision(problem, BundleOptions(), unknown, 3).valid);
}
