// SPDX-License-Identifier: MIT
// Real recordings, where they are at hand.
#include "tests/support/recorded_data.hpp"

#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"

namespace {

struct Expected {
  const char* name;
  const char* format;
  size_t frames;
  size_t poses;
  int64_t last_ns;
  int width;
  int height;
};

}  // namespace

TEST_CASE("real recordings are recognised and read to the end") {
  const Expected expected =
      GENERATE(Expected{"7scenes_redkitchen", "7scenes", 500, 500, 16633333333, 640, 480},
               Expected{"tsdf_box", "7scenes", 50, 50, 3766666667, 640, 480},
               Expected{"kitti_head", "kitti", 51, 51, 5185000000, 1226, 370},
               Expected{"euroc_v101_micro", "euroc", 32, 0, 1403715277912143104, 752, 480},
               Expected{"derived_video/redkitchen_000-499_320x240_mjpg.avi", "video", 500, 0,
                        16633333333, 320, 240},
               Expected{"derived_video/redkitchen_000-499_320x240.mp4", "video", 500, 0,
                        16633333333, 320, 240});
  INFO(expected.name);
  const std::string path = recorded_data(expected.name);
  UNISIM_SKIP_WITHOUT(path);
  const Source source = open_sequence(path);
  REQUIRE(std::string(source->format) == expected.format);
  REQUIRE(source->frame_count(source.get()) == static_cast<int64_t>(expected.frames));
  REQUIRE(truth_of(source).size() == expected.poses);
  const auto answers = play(source);
  REQUIRE(answers.size() == expected.frames);
  for (const Answer& answer : answers) {
    REQUIRE(answer.status == UNISIM_FRAME_OK);
    REQUIRE(answer.image.width == expected.width);
    REQUIRE(answer.image.height == expected.height);
  }
  REQUIRE(std::abs(answers.back().timestamp_ns - expected.last_ns) <= 1);
}
