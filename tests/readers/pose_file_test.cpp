// SPDX-License-Identifier: MIT
// Pose files: formats told apart, times without loss, lines left out.
#include "drivers/sequence/pose_file.hpp"

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/sequence/text_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

using namespace unisim::sequence;

TEST_CASE("tum, kitti and euroc lines are told apart") {
  const TempFolder folder;
  const PoseFile tum = read_pose_file(folder.write("a.txt", "# c\n12.5 1 2 3 0 0 0 1\n"));
  REQUIRE(tum.format == PoseFormat::kTum);
  REQUIRE(tum.poses[0].timestamp_ns == 12500000000);
  REQUIRE(tum.poses[0].translation[2] == 3);
  const PoseFile kitti =
      read_pose_file(folder.write("b.txt", "1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 7 0 1 0 5 0 0 1 6"));
  REQUIRE(kitti.format == PoseFormat::kKitti);
  REQUIRE(kitti.poses.size() == 2);
  REQUIRE(kitti.poses[1].time_s == 1.0);
  REQUIRE(kitti.poses[1].translation[0] == 7);
  const PoseFile numbered = read_pose_file(folder.write("c.txt", "8 1 0 0 4 0 1 0 5 0 0 1 6\n"));
  REQUIRE(numbered.format == PoseFormat::kKitti);
  REQUIRE(numbered.poses[0].time_s == 8.0);
  const PoseFile euroc =
      read_pose_file(folder.write("d.csv", "1403715274312143104.0,1,2,3,1,0,0,0,0.1\r\n"));
  REQUIRE(euroc.format == PoseFormat::kEuroc);
  REQUIRE(euroc.poses[0].timestamp_ns == 1403715274312143104);
}

TEST_CASE("commas alone make no EuRoC file") {
  const TempFolder folder;
  const PoseFile tum = read_pose_file(folder.write(
      "a.csv",
      "time,tx,ty,tz,qx,qy,qz,qw\n1311868164.363181,1,2,3,0,0,0,1\n1311868164.5,1,2,4,0,0,0,1\n"));
  REQUIRE(tum.format == PoseFormat::kTum);
  REQUIRE(tum.poses[0].timestamp_ns == 1311868164363181000);
  REQUIRE(tum.poses[0].rotation[4] == 1.0);
  const PoseFile euroc =
      read_pose_file(folder.write("b.csv", "1403715274312143104,1,2,3,1,0,0,0\n"));
  REQUIRE(euroc.format == PoseFormat::kEuroc);
  REQUIRE(euroc.poses[0].rotation[4] == 1.0);
}

TEST_CASE("lines that are not a pose are counted, not used") {
  const TempFolder folder;
  const PoseFile file = read_pose_file(folder.write("a.txt",
                                                    "1 0 0 0 0 0 0 1\n"
                                                    "2 nan 0 0 0 0 0 1\n"
                                                    "3 0 0 0 0 0 0 0\n"
                                                    "4 0 0 0 0 0 0\n"
                                                    "5 0 0 inf 0 0 0 1\n"
                                                    "6 x 0 0 0 0 0 1\n"
                                                    "7 0 0 0 0 0 0 2\n"));
  REQUIRE(file.poses.size() == 2);
  REQUIRE(file.skipped == 5);
  REQUIRE(file.poses[1].rotation[0] == 1.0);
}

TEST_CASE("a file without a pose is refused with its place") {
  const TempFolder folder;
  REQUIRE_THROWS_AS(read_pose_file(folder / "missing.txt"), InputError);
  REQUIRE_THROWS_AS(read_pose_file(folder.path()), InputError);
  REQUIRE_THROWS_AS(read_pose_file(folder.write("empty.txt", "# nothing\n")), InputError);
  try {
    read_pose_file(folder.write("words.txt", "# c\nhello world\n"));
    FAIL("words were taken for poses");
  } catch (const InputError& error) {
    REQUIRE(std::string(error.what()).find("words.txt:2: no line is a pose") != std::string::npos);
  }
}

TEST_CASE("a rotation survives the way through matrix and quaternion") {
  // Turns near 180 degrees about each axis and a small one: every branch of the conversion.
  const double quaternions[][4] = {{0.9, 0.3, 0.2, 0.1},   {-0.2, 0.95, 0.1, 0.2},
                                   {0.1, -0.2, 0.97, 0.1}, {0.01, 0.02, -0.03, 1},
                                   {1, 0, 0, 0},           {0, 0, 0, 1}};
  const TempFolder folder;
  std::string lines;
  for (const auto& q : quaternions) {
    lines += "1 0 0 0";
    for (const double value : q) lines += " " + std::to_string(value);
    lines += "\n";
  }
  const PoseFile file = read_pose_file(folder.write("q.txt", lines), PoseFormat::kTum);
  for (size_t k = 0; k < file.poses.size(); ++k) {
    const unisim_sim3 T = to_stamped_pose(file.poses[k]).T_world_cam;
    double dot = 0;
    double norm = 0;
    for (size_t i = 0; i < 4; ++i) {
      dot += T.q[i] * quaternions[k][i];
      norm += quaternions[k][i] * quaternions[k][i];
    }
    REQUIRE(std::abs(dot) / std::sqrt(norm) == Approx(1.0).margin(1e-12));
  }
}

TEST_CASE("a matrix that is no rotation is refused") {
  const double scaled[12] = {1.1, 0, 0, 0, 0, 1.1, 0, 0, 0, 0, 1.1, 0};
  FilePose pose;
  REQUIRE_FALSE(pose_from_matrix(scaled, &pose));
}

TEST_CASE("a rate that puts a frame beyond all times is refused") {
  REQUIRE(time_at_rate(3, 30.0) == 100000000);
  REQUIRE_THROWS_AS(time_at_rate(1, 1e-30), InputError);
  REQUIRE_THROWS_AS(time_at_rate(9000000000000000000, 1.0), InputError);
}

TEST_CASE("a frame far on has its time to the nanosecond") {
  CHECK(time_at_rate(27000000001, 30.0) == 900000000033333333);
  CHECK(time_at_rate(-27000000001, 30.0) == -900000000033333333);
  CHECK(time_at_rate(9007199254740991, 1e9) == 9007199254740991);
  CHECK(time_at_rate(2997003, 29.97) == 100000100100100);
}

TEST_CASE("natural order puts 2 before 10") {
  REQUIRE(natural_less("img2.png", "img10.png"));
  REQUIRE_FALSE(natural_less("img10.png", "img2.png"));
  REQUIRE(natural_less("a01b2", "a1b10"));
  REQUIRE(natural_less("a", "a1"));
  REQUIRE(natural_less("x99999999999999999999", "x100000000000000000000"));
  REQUIRE_FALSE(natural_less("same1", "same1"));
  REQUIRE(natural_less("f01", "f1") != natural_less("f1", "f01"));
}
