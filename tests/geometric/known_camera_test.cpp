// SPDX-License-Identifier: MIT
// A calibrated lens: given, it is as good as none; what it bends is not left to the adjustment.
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "drivers/geometric/camera/ideal_view.hpp"
#include "tests/geometric/predictor_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace unisim::geometric::test {

namespace {

constexpr double kWide = 190.0;  // focal length of what the bent images are made from
constexpr double kMiddleX = kWidth / 2.0 - 0.5;
constexpr double kMiddleY = kHeight / 2.0 - 0.5;

unisim_geometric_config barrel() {
  unisim_geometric_config config = default_config();
  config.focal_px = 260;
  config.focal_y_px = 266;
  config.principal_x_px = kMiddleX + 12;
  config.principal_y_px = kMiddleY - 9;
  config.distortion_model = UNISIM_DISTORTION_PINHOLE;
  config.distortion[0] = -0.3;
  config.distortion[1] = 0.08;
  config.distortion[2] = 0.002;
  return config;
}

unisim_geometric_config fisheye() {
  unisim_geometric_config config = barrel();
  config.distortion_model = UNISIM_DISTORTION_FISHEYE;
  config.distortion[0] = -0.02;
  config.distortion[1] = config.distortion[2] = 0;
  return config;
}

/// Slopes (x / z, y / z) of the rays of all pixels of the camera that `config` describes.
std::vector<cv::Point2d> rays(const unisim_geometric_config& config) {
  const cv::Matx33d camera(config.focal_px, 0, config.principal_x_px, 0, config.focal_y_px,
                           config.principal_y_px, 0, 0, 1);
  std::vector<cv::Point2d> pixels;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) pixels.emplace_back(x, y);
  }
  std::vector<cv::Point2d> out;
  if (config.distortion_model == UNISIM_DISTORTION_FISHEYE) {
    cv::fisheye::undistortPoints(pixels, out, camera,
                                 std::vector<double>(config.distortion, config.distortion + 4));
  } else {
    cv::undistortPoints(pixels, out, camera,
                        std::vector<double>(config.distortion, config.distortion + 8));
  }
  return out;
}

/// Images that the camera of `config` takes of the room.
class BentRoom {
 public:
  explicit BentRoom(const unisim_geometric_config& config)
      : x_(kHeight, kWidth, CV_32F), y_(kHeight, kWidth, CV_32F) {
    const std::vector<cv::Point2d> all = rays(config);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const cv::Point2d& ray = all[static_cast<std::size_t>(i)];
      x_.at<float>(i / kWidth, i % kWidth) = static_cast<float>(kMiddleX + kWide * ray.x);
      y_.at<float>(i / kWidth, i % kWidth) = static_cast<float>(kMiddleY + kWide * ray.y);
    }
  }

  GrayImage at(const CameraPlace& place) const {
    GrayImage wide = render_room(place, kWide);
    cv::Mat bent;
    cv::remap(cv::Mat(kHeight, kWidth, CV_8UC1, wide.data()), bent, x_, y_, cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
    return {bent.begin<std::uint8_t>(), bent.end<std::uint8_t>()};
  }

 private:
  cv::Mat x_;
  cv::Mat y_;
};

/// Of 16 keyframes of a walk of 60 frames; large when there is no map.
double walk_error(const unisim_geometric_config& config, const BentRoom* lens, double focal) {
  PredictorRun run(config);
  for (int step = 0; step < 60; ++step) {
    const CameraPlace place = walk(step);
    run.show(lens != nullptr ? lens->at(place) : render_room(place, focal), step % 3 == 0);
  }
  const std::vector<unisim_sim3> poses = run.window(4, 16);
  std::vector<CameraPlace> truth;
  for (int step = 12; step < 60; step += 3) truth.push_back(walk(step));
  return poses.size() == truth.size() ? relative_error(poses, truth) : 1.0;
}

}  // namespace

TEST_CASE("a known lens costs next to nothing, an unknown one of two numbers too many does") {
  unisim_geometric_config plain = default_config();
  plain.focal_px = 260;
  const double ideal = walk_error(plain, nullptr, 260);
  for (const unisim_geometric_config& camera : {barrel(), fisheye()}) {
    INFO("distortion_model " << camera.distortion_model);
    const BentRoom room(camera);
    const double known = walk_error(camera, &room, 0);
    const double unknown = walk_error(default_config(), &room, 0);
    INFO("ideal camera " << ideal << ", known lens " << known << ", unknown " << unknown);
    CHECK(known < 2 * ideal + 0.002);
    CHECK(known < 0.7 * unknown);
  }
}

TEST_CASE("features are told where they lie in the image as it came") {
  const unisim_geometric_config camera = barrel();
  unisim_geometric_config changed = camera;
  IdealView view;
  REQUIRE(view.open({kWidth, kHeight}, &changed).empty());
  REQUIRE(view.active());
  CHECK(changed.focal_px == Approx(std::sqrt(260.0 * 266.0)));
  const std::vector<cv::Point2d> all = rays(camera);
  for (const cv::Point pixel : {cv::Point(60, 170), cv::Point(160, 120), cv::Point(250, 60)}) {
    const cv::Point2d ray = all[static_cast<std::size_t>(pixel.y * kWidth + pixel.x)];
    const cv::Point2d ideal(kMiddleX + changed.focal_px * ray.x,
                            kMiddleY + changed.focal_px * ray.y);
    const cv::Point2f found = view.place_in_image(ideal);
    CHECK(cv::norm(cv::Point2d(found) - cv::Point2d(pixel)) < 0.3);
  }
}

TEST_CASE("an ideal camera's images go on as they come") {
  unisim_geometric_config camera = default_config();
  camera.focal_px = 600;
  camera.principal_x_px = kWidth - 0.5;
  camera.principal_y_px = kHeight - 0.5;
  camera.distortion_model = UNISIM_DISTORTION_PINHOLE;
  camera.calibrated_width = 2 * kWidth;
  camera.calibrated_height = 2 * kHeight;
  IdealView view;
  REQUIRE(view.open({kWidth, kHeight}, &camera).empty());
  CHECK_FALSE(view.active());
  CHECK(camera.focal_px == Approx(300));
}

TEST_CASE("beyond the angle at which its polynomial turns back a lens is said to see nothing") {
  unisim_geometric_config camera = barrel();
  camera.focal_px = camera.focal_y_px = 120;
  camera.distortion[1] = camera.distortion[2] = 0;  // turns at a slope of 1.05, 126 pixels
  IdealView view;
  REQUIRE(view.open({kWidth, kHeight}, &camera).empty());
  REQUIRE(camera.mask.data != nullptr);
  const auto seen = [&](int x, int y) { return camera.mask.data[y * camera.mask.stride + x] != 0; };
  CHECK(seen(kWidth / 2, kHeight / 2));
  CHECK_FALSE(seen(2, 2));
  CHECK_FALSE(seen(kWidth - 3, kHeight / 2));
}

TEST_CASE("frames of another shape than the calibration's end the run with both sizes") {
  unisim_geometric_config camera = barrel();
  camera.calibrated_width = 640;
  camera.calibrated_height = 360;
  PredictorRun run(camera);
  CHECK(run.show(render_room(walk(0)), false) == UNISIM_PREDICTION_FAILED);
  CHECK(has(run.table()->message(run.table()), "640x360"));
  CHECK(has(run.table()->message(run.table()), "320x240"));
}

TEST_CASE("a camera that cannot be is refused at creation") {
  char message[256] = "";
  const auto refused = [&](const unisim_geometric_config& config) {
    unisim_predictor* made = unisim_geometric_create(&config, message, sizeof message);
    if (made != nullptr) made->destroy(made);
    return made == nullptr;
  };
  CHECK_FALSE(refused(barrel()));
  unisim_geometric_config camera = barrel();
  camera.focal_px = 0;
  CHECK(refused(camera));
  CHECK(has(message, "focal_px"));
  camera = barrel();
  camera.principal_y_px = 0;
  CHECK(refused(camera));
  camera = barrel();
  camera.distortion[3] = NAN;
  CHECK(refused(camera));
  camera = fisheye();
  camera.distortion[5] = 0.1;
  CHECK(refused(camera));
  CHECK(has(message, "term 6"));
  camera = barrel();
  camera.distortion_model = 3;
  CHECK(refused(camera));
}

}  // namespace unisim::geometric::test
