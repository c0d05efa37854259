// SPDX-License-Identifier: MIT
#include "drivers/geometric/start/intrinsics.hpp"

#include <cstring>
#include <vector>

#include "drivers/common/archive.hpp"
#include "tests/support/catch.hpp"

using unisim::geometric::BundleIntrinsics;
using unisim::geometric::Intrinsics;

// A lens bends the image whether or not its focal length is known: held at zero, redkitchen by
// motion with the true focal length ended at 0.0120 m instead of 0.0044 m.
TEST_CASE("a known focal length is held, the radial term is still estimated") {
  const cv::Size size(640, 480);
  Intrinsics intrinsics = Intrinsics::start(size, 525.5);
  intrinsics.note_rotation(0.5);
  BundleIntrinsics problem;
  intrinsics.give(false, &problem);
  CHECK_FALSE(problem.free_focal);
  CHECK(problem.free_k1);

  unisim::geometric::CameraModel found = intrinsics.camera;
  found.focal_px = 600.0;
  found.k1 = 0.03;
  problem.set_model(found);
  intrinsics.take(problem, size);
  CHECK(intrinsics.camera.focal_px == 525.5);
  CHECK(intrinsics.camera.k1 == Approx(0.03));
}

TEST_CASE("the radial term is held until the camera has turned a little") {
  Intrinsics intrinsics = Intrinsics::start(cv::Size(640, 480), 0);
  BundleIntrinsics problem;
  intrinsics.note_rotation(0.03);
  intrinsics.give(false, &problem);
  CHECK_FALSE(problem.free_k1);
  intrinsics.note_rotation(0.07);
  intrinsics.give(false, &problem);
  CHECK(problem.free_k1);
}

TEST_CASE("the prior on the radial term lets a barrel lens go far, and only that") {
  Intrinsics intrinsics = Intrinsics::start(cv::Size(640, 480), 0);
  const auto sigma_at = [&](double k1) {
    intrinsics.camera.k1 = k1;
    BundleIntrinsics problem;
    intrinsics.give(false, &problem);
    return problem.k1_sigma;
  };
  CHECK(sigma_at(0.0) == Approx(0.02));
  CHECK(sigma_at(0.04) == Approx(0.02));
  CHECK(sigma_at(0.3) > 0.2);
  CHECK(sigma_at(-0.3) == Approx(0.02));
}

TEST_CASE("the principal point is held in the middle until the camera has turned") {
  const cv::Size size(640, 480);
  Intrinsics intrinsics = Intrinsics::start(size, 0);
  BundleIntrinsics problem;
  intrinsics.note_rotation(0.15);
  intrinsics.give(false, &problem);
  CHECK_FALSE(problem.free_center);
  intrinsics.note_rotation(0.25);
  intrinsics.give(true, &problem);
  CHECK_FALSE(problem.free_center);  // while the state is young
  intrinsics.give(false, &problem);
  CHECK(problem.free_center);
  CHECK(problem.cx_mean == 319.5);
  CHECK(problem.cy_mean == 239.5);

  problem.cx = 322.0;
  problem.cy = 1000.0;  // in no camera
  intrinsics.take(problem, size);
  CHECK(intrinsics.camera.cx == 322.0);
  CHECK(intrinsics.camera.cy == 319.5);
}

TEST_CASE("a principal point that was given is held") {
  Intrinsics intrinsics = Intrinsics::start(cv::Size(640, 480), 0, false, true);
  BundleIntrinsics problem;
  intrinsics.note_rotation(1.0);
  intrinsics.give(false, &problem);
  CHECK_FALSE(problem.free_center);
}

TEST_CASE("the readout of a rolling shutter is estimated where it was asked for and shows") {
  const cv::Size size(640, 480);
  Intrinsics global = Intrinsics::start(size, 0);
  BundleIntrinsics problem;
  global.note_rotation(1.0);
  global.give(false, &problem);
  CHECK_FALSE(problem.free_readout);

  Intrinsics rolling = Intrinsics::start(size, 0);
  rolling.roll(0);
  rolling.note_rotation(0.03);
  rolling.give(false, &problem);
  CHECK_FALSE(problem.free_readout);  // not turned
  rolling.note_rotation(0.1);
  rolling.give(true, &problem);
  CHECK_FALSE(problem.free_readout);  // while the state is young
  rolling.give(false, &problem);
  CHECK(problem.free_readout);
  CHECK(problem.readout_sigma_s > 0);
  problem.readout_s = 0.018;
  rolling.take(problem, size);
  CHECK(rolling.readout_s == 0.018);

  Intrinsics given = Intrinsics::start(size, 0);
  given.roll(0.025);
  given.note_rotation(1.0);
  given.give(false, &problem);
  CHECK_FALSE(problem.free_readout);
  CHECK(problem.readout_s == 0.025);
}

TEST_CASE("a long focal length that was given is loaded again") {
  using unisim::drivers::Archive;
  const cv::Size size(640, 480);
  Intrinsics saved = Intrinsics::start(size, 5000.0);  // 7.8 image widths: no estimate goes there
  std::vector<unsigned char> bytes;
  const auto write = [](void* context, const void* from, size_t count) -> int32_t {
    const auto* first = static_cast<const unsigned char*>(from);
    auto* to = static_cast<std::vector<unsigned char>*>(context);
    to->insert(to->end(), first, first + count);
    return 1;
  };
  Archive out(static_cast<Archive::Write>(write), &bytes);
  saved.archive(&out, size);

  const auto read = [](void* context, void* to, size_t count) -> int32_t {
    auto* from = static_cast<std::vector<unsigned char>*>(context);
    if (from->size() < count) return 0;
    std::memcpy(to, from->data(), count);
    from->erase(from->begin(), from->begin() + static_cast<std::ptrdiff_t>(count));
    return 1;
  };
  Archive in(static_cast<Archive::Read>(read), &bytes);
  Intrinsics loaded = Intrinsics::start(size, 5000.0);
  loaded.archive(&in, size);
  CHECK(bytes.empty());
  CHECK(loaded.camera.focal_px == 5000.0);
}
