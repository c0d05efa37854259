// SPDX-License-Identifier: MIT
// Trajectories seen from above.
#include "tools/eval/top_view.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/common/format.hpp"

namespace unisim::eval {
namespace {

constexpr int kSize_px = 900;
constexpr int kMargin_px = 70;
const cv::Scalar kTruthColour(120, 120, 120), kEstimateColour(200, 90, 20),
    kErrorColour(150, 150, 235), kTextColour(40, 40, 40);

using Points2 = std::vector<Eigen::Vector2d>;

// Metres to pixels so that all points fit.
class Frame {
 public:
  explicit Frame(const std::vector<const Points2*>& sets) {
    Eigen::AlignedBox2d box;
    for (const Points2* set : sets) {
      for (const Eigen::Vector2d& p : *set) box.extend(p);
    }
    center_ = box.center();
    px_per_metre_ = (kSize_px - 2 * kMargin_px) / std::max(box.sizes().maxCoeff(), 1e-9);
  }
  double px_per_metre() const { return px_per_metre_; }
  cv::Point place(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q = (p - center_) * px_per_metre_;
    return {cvRound(kSize_px / 2.0 + q.x()), cvRound(kSize_px / 2.0 - q.y())};
  }

 private:
  Eigen::Vector2d center_;
  double px_per_metre_ = 1;
};

Points2 project(const Eigen::Matrix<double, 2, 3>& axes,
                const std::vector<Eigen::Vector3d>& points) {
  Points2 out;
  for (const Eigen::Vector3d& p : points) out.emplace_back(axes * p);
  return out;
}

void draw_path(cv::Mat& image, const Frame& frame, const Points2& path, const cv::Scalar& colour) {
  for (size_t k = 1; k < path.size(); ++k) {
    cv::line(image, frame.place(path[k - 1]), frame.place(path[k]), colour, 2, cv::LINE_AA);
  }
}

void draw_text(cv::Mat& image, int line, const std::string& text, const cv::Scalar& colour) {
  cv::putText(image, text, {20, 28 + 22 * line}, cv::FONT_HERSHEY_SIMPLEX, 0.55, colour, 1,
              cv::LINE_AA);
}

// A bar of 1, 2 or 5 times a power of ten, a fifth of the picture at most.
void draw_scale_bar(cv::Mat& image, const Frame& frame) {
  const double longest = kSize_px / 5.0 / frame.px_per_metre();
  const double decade = std::pow(10.0, std::floor(std::log10(longest)));
  const double metres = decade * (longest / decade >= 5 ? 5 : longest / decade >= 2 ? 2 : 1);
  const int width = cvRound(metres * frame.px_per_metre());
  cv::line(image, {20, kSize_px - 20}, {20 + width, kSize_px - 20}, kTextColour, 3);
  cv::putText(image, drivers::format("%g m", metres), {26 + width, kSize_px - 16},
              cv::FONT_HERSHEY_SIMPLEX, 0.5, kTextColour, 1, cv::LINE_AA);
}

}  // namespace

Eigen::Matrix<double, 2, 3> top_view_axes(const Trajectory& trajectory) {
  Eigen::Vector3d down = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Pose& pose : trajectory.poses) {
    down += pose.R.col(1);
    mean += pose.t / static_cast<double>(trajectory.poses.size());
  }
  const Eigen::Vector3d up =
      down.norm() > 1e-9 ? Eigen::Vector3d(-down.normalized()) : Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d flatten = Eigen::Matrix3d::Identity() - up * up.transpose();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Pose& pose : trajectory.poses) {
    const Eigen::Vector3d p = flatten * (pose.t - mean);
    scatter += p * p.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  Eigen::Vector3d right = flatten * solver.eigenvectors().col(2);
  if (right.norm() < 1e-6) right = flatten * up.unitOrthogonal();
  right.normalize();
  Eigen::Matrix<double, 2, 3> axes;
  axes.row(0) = right.transpose();
  axes.row(1) = up.cross(right).transpose();
  return axes;
}

bool write_top_view(const std::string& path, const Trajectory& ground_truth, const Ate& ate) {
  const Eigen::Matrix<double, 2, 3> axes = top_view_axes(ground_truth);
  std::vector<Eigen::Vector3d> positions;
  for (const Pose& pose : ground_truth.poses) positions.push_back(pose.t);
  const Points2 truth = project(axes, positions);
  const Points2 partners = project(axes, ate.truth_position);
  const Points2 estimate = project(axes, ate.aligned_position);
  const Frame frame({&truth, &estimate});
  cv::Mat image(kSize_px, kSize_px, CV_8UC3, cv::Scalar::all(255));
  for (size_t k = 0; k < estimate.size(); ++k) {
    cv::line(image, frame.place(partners[k]), frame.place(estimate[k]), kErrorColour, 1,
             cv::LINE_AA);
  }
  draw_path(image, frame, truth, kTruthColour);
  draw_path(image, frame, estimate, kEstimateColour);
  const std::string figures =
      drivers::format("ATE rmse %.4f m, max %.4f m, scale %.4f, %zu poses", ate.error.rmse,
                      ate.error.max, ate.T_truth_estimate.s, ate.error.count);
  draw_text(image, 0, figures, kTextColour);
  draw_text(image, 1, "ground truth, from above", kTruthColour);
  draw_text(image, 2, "estimate", kEstimateColour);
  draw_scale_bar(image, frame);
  try {
    return cv::imwrite(path, image);
  } catch (const cv::Exception&) {
    return false;
  }
}

}  // namespace unisim::eval
