// SPDX-License-Identifier: MIT
// Frames that carry their truth: every number comes back from the pixels.
#include "tools/synth/encoding.hpp"

#include "tests/support/catch.hpp"

namespace {

using namespace unisim::synth;

/// The whole number of 24 bits in a pixel, red the high byte.
int number(const cv::Mat& image, int row, int column) {
  const auto& pixel = image.at<cv::Vec3b>(row, column);
  return pixel[2] << 16 | pixel[1] << 8 | pixel[0];
}

EncodedHeader header() {
  EncodedHeader header{Eigen::Isometry3d::Identity(), 0.625, 0.25};
  header.T_world_cam.linear() =
      Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  header.T_world_cam.translation() << 1.5, -2.25, 0.125;
  return header;
}

}  // namespace

TEST_CASE("pose, focal length, share and spread stand in the first row") {
  const Camera camera{40, 32, 33.5, 0};
  const cv::Mat image = encode_frame(DepthImage(40 * 32, 1.0f), camera, header());
  for (int i = 0; i < 9; ++i) {
    const double found = number(image, 0, i) * 0x1p-22 - 2;
    CHECK(found == Approx(header().T_world_cam.linear()(i / 3, i % 3)).margin(2e-7));
  }
  CHECK(number(image, 0, 9) * 0x1p-18 - 32 == 1.5);
  CHECK(number(image, 0, 10) * 0x1p-18 - 32 == -2.25);
  CHECK(number(image, 0, 11) * 0x1p-18 - 32 == 0.125);
  CHECK(number(image, 0, 12) * 0x1p-10 == 33.5);
  CHECK(number(image, 0, 13) * 0x1p-24 == 0.625);
  CHECK(number(image, 0, 14) * 0x1p-24 == 0.25);
}

TEST_CASE("depth stands below it, nothing seen is the farthest") {
  const Camera camera{40, 32, 33.5, 0};
  DepthImage depth(40 * 32, 2.5f);
  depth[41] = 0;
  depth[42] = 1e-9f;
  depth[43] = 100;
  const cv::Mat image = encode_frame(depth, camera, header());
  CHECK(number(image, 1, 0) * 0x1p-20 == 2.5);
  CHECK(number(image, 1, 1) == (1 << 24) - 1);
  CHECK(number(image, 1, 2) == 1);
  CHECK(number(image, 1, 3) == (1 << 24) - 1);
}
