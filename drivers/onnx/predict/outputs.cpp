// SPDX-License-Identifier: MIT
// From a model's outputs to a prediction.
#include "drivers/onnx/predict/outputs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "drivers/onnx/predict/nearest_rotation.hpp"

namespace unisim::onnx {
namespace {

using Matrix34 = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
std::string of_view(const char* what, int32_t view) {
  return std::string(what) + " of view " + std::to_string(view);
}

}  // namespace

Outputs::Outputs(int32_t views, const Framing& framing)
    : framing_(framing),
      pixels_(static_cast<size_t>(framing.width) * static_cast<size_t>(framing.height)),
      depth_(static_cast<size_t>(views) * pixels_),
      confidence_(static_cast<size_t>(views) * pixels_),
      T_0_view_(static_cast<size_t>(views)),
      maps_(static_cast<size_t>(views)),
      ranker_(pixels_) {
  for (size_t view = 0; view < maps_.size(); ++view) {
    maps_[view] = {depth_.data() + view * pixels_, confidence_.data() + view * pixels_,
                   framing.width, framing.height};
  }
}

std::string Outputs::read(const Model& model, int32_t views) {
  std::string problem = read_poses(model, views);
  if (problem.empty()) problem = read_focal(model, views);
  for (int32_t view = 0; view < views && problem.empty(); ++view) problem = read_maps(model, view);
  return problem;
}

std::string Outputs::read_poses(const Model& model, int32_t views) {
  Eigen::Quaterniond q_first = Eigen::Quaterniond::Identity();
  Eigen::Vector3d t_first = Eigen::Vector3d::Zero();
  for (int32_t view = 0; view < views; ++view) {
    const Eigen::Matrix<double, 3, 4> given =
        Eigen::Map<const Matrix34>(model.pose(view)).cast<double>();
    if (!given.allFinite()) return of_view("pose", view) + " is not finite";
    Eigen::Quaterniond q_view;
    if (!nearest_rotation(given.leftCols<3>(), &q_view)) {
      return of_view("rotation", view) + " is degenerate";
    }
    const Eigen::Vector3d t_view = given.col(3);
    if (view == 0) {
      q_first = q_view;
      t_first = t_view;
    }
    // Any gauge is allowed: even models that are trained on view 0 as the world only come near it.
    Eigen::Quaterniond q = (q_first.conjugate() * q_view).normalized();
    if (q.w() < 0) q.coeffs() *= -1;  // the same of the two in every recording
    const Eigen::Vector3d t = q_first.conjugate() * (t_view - t_first);
    T_0_view_[static_cast<size_t>(view)] = {
        {q.x(), q.y(), q.z(), q.w()}, {t.x(), t.y(), t.z()}, 1.0};
  }
  T_0_view_[0] = {{0, 0, 0, 1}, {0, 0, 0}, 1.0};
  return "";
}

std::string Outputs::read_focal(const Model& model, int32_t views) {
  double sum_log = 0;
  for (int32_t view = 0; view < views; ++view) {
    const Pinhole pinhole =
        image_intrinsics(framing_, model.intrinsics(view), model.contract().pixel_center);
    const bool finite = std::isfinite(pinhole.fx) && std::isfinite(pinhole.fy) &&
                        std::isfinite(pinhole.cx) && std::isfinite(pinhole.cy);
    if (!finite) return of_view("intrinsics", view) + " are not finite";
    if (pinhole.fx <= 0 || pinhole.fy <= 0)
      return of_view("focal length", view) + " is not above 0";
    sum_log += 0.5 * std::log(pinhole.fx * pinhole.fy);
  }
  focal_px_ = std::exp(sum_log / views);
  return "";
}

std::string Outputs::read_maps(const Model& model, int32_t view) {
  const float* const depth = model.depth(view);
  const float* const confidence = model.confidence(view);
  for (int64_t i = 0; i < model.pixels(); ++i) {
    if (!std::isfinite(depth[i])) return of_view("depth", view) + " is not finite";
    if (!(depth[i] > 0)) return of_view("depth", view) + " is not above 0";
    if (!std::isfinite(confidence[i])) return of_view("confidence", view) + " is not finite";
  }
  const size_t offset = static_cast<size_t>(view) * pixels_;
  // Where the model did not see: no depth, and less confident than anything else.
  const float least = *std::min_element(confidence, confidence + model.pixels());
  to_image_grid(framing_, depth, 0.0f, depth_.data() + offset);
  to_image_grid(framing_, confidence, least, confidence_.data() + offset);
  ranker_.rank(confidence_.data() + offset, pixels_);
  return "";
}

int64_t Outputs::bytes() const {
  return static_cast<int64_t>((depth_.size() + confidence_.size()) * sizeof(float) +
                              pixels_ * sizeof(uint64_t));
}

}  // namespace unisim::onnx
