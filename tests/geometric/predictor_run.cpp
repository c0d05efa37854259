// SPDX-License-Identifier: MIT
// Drives a geometric predictor through its table, as the pipeline does.
#include "tests/geometric/predictor_run.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

/// Rendering costs more than tracking: each view is made once.
const GrayImage& view(CameraPlace (*path)(int), int step) {
  static std::map<std::pair<CameraPlace (*)(int), int>, GrayImage> made;
  const auto key = std::make_pair(path, step);
  const auto found = made.find(key);
  return found != made.end() ? found->second
                             : made.emplace(key, render_room(path(step))).first->second;
}

}  // namespace

PredictorRun::PredictorRun(const unisim_geometric_config& config) {
  char message[256] = "";
  table_.reset(unisim_geometric_create(&config, message, sizeof message));
  INFO(message);
  REQUIRE(table_ != nullptr);
}

int PredictorRun::show(const GrayImage& image, bool keyframe) {
  unisim_frame frame{};
  frame.index = frames_;
  frame.timestamp_ns = int64_t{frames_++} * 33000000;
  frame.image = {image.data(), kWidth, kHeight, kWidth, UNISIM_PIXEL_GRAY8};
  const int answer = table_->observe(table_.get(), &frame, &motion_);
  if (keyframe) {
    const int taken = table_->keyframe(table_.get(), &frame, keyframes_++);
    INFO(table_->message(table_.get()));
    REQUIRE(taken == UNISIM_PREDICTION_OK);
  }
  return answer;
}

void PredictorRun::show_path(CameraPlace (*path)(int), int count, int stride) {
  for (int step = 0; step < count; ++step) {
    const bool keyframe = step % stride == 0;
    if (keyframe) places_.push_back(path(step));
    REQUIRE(show(view(path, step), keyframe) == UNISIM_PREDICTION_OK);
  }
}

std::vector<unisim_sim3> PredictorRun::window(int first, int count) {
  std::vector<int32_t> ids(static_cast<std::size_t>(count));
  std::iota(ids.begin(), ids.end(), first);
  unisim_window_prediction out{};
  if (table_->multi_view(table_.get(), ids.data(), count, &out) != UNISIM_PREDICTION_OK) return {};
  return {out.T_window_kf, out.T_window_kf + out.count};
}

unisim_predictor_info PredictorRun::info() {
  unisim_predictor_info out{};
  table_->info(table_.get(), &out);
  return out;
}

void show_walk(PredictorRun* run, int from, int to) {
  for (int step = from; step < to; ++step) run->show(render_room(walk(step)), step % kStride == 0);
}

unisim_geometric_config default_config() {
  unisim_geometric_config config{};
  unisim_geometric_config_init(&config, sizeof config);
  return config;
}

double relative_error(const std::vector<unisim_sim3>& found,
                      const std::vector<CameraPlace>& truth) {
  const auto count = static_cast<Eigen::Index>(std::min(found.size(), truth.size()));
  Eigen::Matrix3Xd a(3, count);
  Eigen::Matrix3Xd b(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    a.col(i) = Eigen::Vector3d(found[at].t[0], found[at].t[1], found[at].t[2]);
    b.col(i) = truth[at].center;
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(a, b, true);
  const Eigen::Matrix3Xd moved =
      (fit.topLeftCorner<3, 3>() * a).colwise() + Eigen::Vector3d(fit.topRightCorner<3, 1>());
  const double extent = (b.colwise() - b.rowwise().mean()).colwise().norm().maxCoeff();
  return (moved - b).colwise().norm().maxCoeff() / extent;
}

}  // namespace unisim::geometric::test
