// SPDX-License-Identifier: MIT
// What becomes of the poses of a file: order, repeats, which pose is which.
#include "tools/eval/trajectory.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/eval/ate.hpp"

using namespace unisim::eval;

namespace {

// A helix of 30 poses as lines of a TUM file.
std::vector<std::string> helix_lines() {
  std::vector<std::string> lines;
  for (int k = 0; k < 30; ++k) {
    const double a = 0.2 * k;
    lines.push_back(std::to_string(100 + 0.1 * k) + " " + std::to_string(std::cos(a)) + " " +
                    std::to_string(std::sin(a)) + " " + std::to_string(0.1 * a) + " 0 0 0 1\n");
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

double self_error(const Trajectory& trajectory) {
  return absolute_trajectory_error(trajectory, trajectory, Alignment::kNone, 0.02).error.max;
}

}  // namespace

TEST_CASE("poses are sorted by time, and it is noted") {
  const TempFolder folder;
  std::vector<std::string> lines = helix_lines();
  const Trajectory sorted = read_trajectory(folder.write("sorted.txt", joined(lines)));
  REQUIRE(sorted.notes.empty());
  std::reverse(lines.begin(), lines.end());
  const Trajectory reversed = read_trajectory(folder.write("reversed.txt", joined(lines)));
  REQUIRE(reversed.notes.size() == 1);
  REQUIRE(reversed.notes[0].find("reversed.txt: not in the order of time") != std::string::npos);
  REQUIRE(reversed.poses.size() == 30);
  REQUIRE(absolute_trajectory_error(sorted, reversed, Alignment::kNone, 0.02).error.max == 0.0);
}

TEST_CASE("of poses with one time the first counts, and a file against itself has no error") {
  const TempFolder folder;
  std::vector<std::string> lines = helix_lines();
  for (size_t k = 10; k < 13; ++k) lines[k].replace(0, 10, lines[9].substr(0, 10));
  const Trajectory trajectory = read_trajectory(folder.write("repeats.txt", joined(lines)));
  REQUIRE(trajectory.poses.size() == 27);
  REQUIRE(trajectory.poses[9].t.x() == Approx(std::cos(0.2 * 9)).margin(1e-6));
  REQUIRE(trajectory.notes.size() == 1);
  REQUIRE(trajectory.notes[0].find("3 poses have the time of another") != std::string::npos);
  REQUIRE(self_error(trajectory) == 0.0);
}

TEST_CASE("poses from memory are put in order as those of a file") {
  std::vector<unisim_stamped_pose> poses(3);
  for (size_t k = 0; k < 3; ++k) {
    poses[k].T_world_cam.q[3] = 1;
    poses[k].T_world_cam.t[0] = static_cast<double>(k);
  }
  poses[0].timestamp_ns = 2000000000;
  poses[1].timestamp_ns = 1000000000;
  poses[2].timestamp_ns = 2000000000;
  const Trajectory trajectory = make_trajectory("made", poses.data(), 3);
  REQUIRE(trajectory.poses.size() == 2);
  REQUIRE(trajectory.poses[0].t.x() == 1.0);
  REQUIRE(trajectory.poses[1].t.x() == 0.0);
}

TEST_CASE("matrices are known by their frame number where they have one, else by their line") {
  const TempFolder folder;
  const std::string matrix = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const Trajectory plain =
      read_trajectory(folder.write("plain.txt", matrix + "nan" + matrix.substr(1) + matrix));
  REQUIRE(plain.by_line);
  REQUIRE(plain.lines == 3);
  REQUIRE(plain.poses.size() == 2);
  REQUIRE(plain.poses[1].time_s == 2.0);
  const Trajectory numbered =
      read_trajectory(folder.write("numbered.txt", "7 " + matrix + "3 " + matrix));
  REQUIRE_FALSE(numbered.by_line);
  REQUIRE(numbered.poses[0].time_s == 3.0);
  REQUIRE_FALSE(numbered.has_times());
}
