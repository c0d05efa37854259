// SPDX-License-Identifier: MIT
// Each format of image files: found by itself, times, order, ground truth.
#include <cmath>

#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"

namespace {

// Camera to world: a quarter turn about z, then a shift.
constexpr const char* kQuarterTurn = "0 -1 0 1.5\n1 0 0 2.5\n0 0 1 3.5\n0 0 0 1\n";

void require_quarter_turn(const unisim_stamped_pose& pose) {
  const unisim_sim3& T = pose.T_world_cam;
  REQUIRE(T.q[0] == Approx(0).margin(1e-12));
  REQUIRE(T.q[1] == Approx(0).margin(1e-12));
  REQUIRE(T.q[2] == Approx(std::sqrt(0.5)).margin(1e-12));
  REQUIRE(T.q[3] == Approx(std::sqrt(0.5)).margin(1e-12));
  REQUIRE(T.t[0] == 1.5);
  REQUIRE(T.t[1] == 2.5);
  REQUIRE(T.t[2] == 3.5);
  REQUIRE(T.s == 1.0);
}

void write_tum(const TempFolder& folder, const std::string& list_name, const std::string& list) {
  write_image(folder, "rgb/a 1.png", 10);
  write_image(folder, "rgb/a 2.png", 20);
  folder.write(list_name, list);
}

}  // namespace

TEST_CASE("tum: times to the nanosecond, blanks in names, comments, CRLF") {
  const TempFolder folder;
  write_tum(folder, "rgb.txt",
            "\xEF\xBB\xBF# color images\r\n# timestamp filename\r\n1305031102.175304123 rgb/a "
            "1.png\r\n\r\n"
            "1305031102.211214 rgb/a 2.png  \r\n");
  folder.write("groundtruth.txt", "# t\r\n1305031102.17 1.5 2.5 3.5 0 0 1 1\r\n");
  const Source source = open_sequence(folder.path());
  REQUIRE(std::string(source->format) == "tum");
  REQUIRE(source->frame_count(source.get()) == 2);
  const auto answers = play(source);
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].status == UNISIM_FRAME_OK);
  REQUIRE(answers[0].timestamp_ns == 1305031102175304123);
  REQUIRE(answers[1].timestamp_ns == 1305031102211214000);
  REQUIRE(answers[0].pixel == 10);
  REQUIRE(answers[1].pixel == 20);
  REQUIRE(answers[1].index == 1);
  REQUIRE(answers[1].image.width == 32);
  REQUIRE(answers[1].image.height == 24);
  REQUIRE(answers[1].image.format == UNISIM_PIXEL_BGR8);
  REQUIRE(truth_of(source).size() == 1);
  require_quarter_turn(truth_of(source)[0]);
  REQUIRE(std::string(source->ground_truth_path(source.get())) == folder / "groundtruth.txt");
}

TEST_CASE("tum: associations in either order") {
  const std::string colour_first =
      "1.5 rgb/a 1.png 1.51 depth/1.png\n1.6 rgb/a 2.png 1.61 depth/2.png\n";
  const std::string depth_first =
      "1.51 depth/1.png 1.5 rgb/a 1.png\n1.61 depth/2.png 1.6 rgb/a 2.png\n";
  const std::string list = GENERATE_COPY(colour_first, depth_first);
  const TempFolder folder;
  write_tum(folder, "associations.txt", list);
  const auto answers = play(open_sequence(folder.path()));
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].pixel == 10);
  REQUIRE(answers[0].timestamp_ns == 1500000000);
  REQUIRE(answers[1].pixel == 20);
  REQUIRE(answers[1].timestamp_ns == 1600000000);
}

TEST_CASE("7scenes: times from frame numbers, gaps are gaps in time, seq-NN is found") {
  const TempFolder folder;
  write_image(folder, "seq-01/frame-000015.color.png", 15);
  write_image(folder, "seq-01/frame-000018.color.jpg", 18);
  write_image(folder, "seq-01/frame-000018.depth.png", 99);
  folder.write("seq-01/frame-000015.pose.txt", kQuarterTurn);
  folder.write("seq-01/frame-000018.pose.txt",
               "nan nan nan nan\nnan nan nan nan\nnan nan nan nan\n0 0 0 1\n");
  const Source source = open_sequence(folder.path());
  REQUIRE(std::string(source->format) == "7scenes");
  const auto answers = play(source);
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].timestamp_ns == 500000000);
  REQUIRE(answers[1].timestamp_ns == 600000000);
  REQUIRE(answers[1].index == 1);
  REQUIRE(truth_of(source).size() == 1);
  require_quarter_turn(truth_of(source)[0]);
  REQUIRE(truth_of(source)[0].timestamp_ns == 500000000);
  REQUIRE(notes_of(source).find("1 poses left out") != std::string::npos);
  REQUIRE(open_sequence(folder / "seq-01", "7scenes", 0, 0, 10)->frame_count(source.get()) == 2);
}

TEST_CASE("7scenes: several sequences in a folder are named") {
  const TempFolder folder;
  write_image(folder, "seq-01/frame-000000.color.png", 1);
  write_image(folder, "seq-02/frame-000000.color.png", 1);
  const std::string message = open_failure(folder.path());
  REQUIRE(message.find("seq-01 to seq-02") != std::string::npos);
}

TEST_CASE("kitti: root, sequence folder, times.txt, poses by line") {
  const TempFolder folder;
  for (int k = 0; k < 3; ++k) {
    write_image(folder, "sequences/06/image_0/00000" + std::to_string(k) + ".png", 10 + k, 32, 24,
                true);
  }
  folder.write("sequences/06/times.txt", "0.0\n0.11\n2.2e-1\n");
  folder.write("poses/06.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1.5 1 0 0 2.5 0 0 1 3.5\n");
  const std::string part = GENERATE(as<std::string>{}, "", "sequences/06", "sequences/06/");
  const std::string path = folder / part;
  const Source source = open_sequence(path);
  REQUIRE(std::string(source->format) == "kitti");
  const auto answers = play(source);
  REQUIRE(answers.size() == 3);
  REQUIRE(answers[0].image.format == UNISIM_PIXEL_GRAY8);
  REQUIRE(answers[2].pixel == 12);
  REQUIRE(answers[2].timestamp_ns == 220000000);
  REQUIRE(truth_of(source).size() == 2);
  require_quarter_turn(truth_of(source)[1]);
  REQUIRE(truth_of(source)[1].timestamp_ns == 110000000);
}

TEST_CASE("kitti: without times.txt 10 Hz, or the times of a ground truth with a line per image") {
  const TempFolder folder;
  for (int k = 0; k < 2; ++k) write_image(folder, "image_0/00000" + std::to_string(k) + ".png", k);
  REQUIRE(play(open_sequence(folder.path()))[1].timestamp_ns == 100000000);
  REQUIRE(play(open_sequence(folder.path(), "kitti", 0, 0, 20))[1].timestamp_ns == 50000000);

  const TempFolder timed;
  for (int k = 0; k < 2; ++k)
    write_image(timed, "sequences/01/image_2/" + std::to_string(k) + ".png", k);
  timed.write("poses/01_groundtruth.txt", "0 0 0 0 0 0 0 1\n0.1037 0 0 1 0 0 0 1\n");
  const Source source = open_sequence(timed.path());
  REQUIRE(play(source)[1].timestamp_ns == 103700000);
  REQUIRE(truth_of(source)[1].timestamp_ns == 103700000);
}

TEST_CASE("euroc: csv list, nanoseconds, ground truth of the body moved to the camera") {
  const TempFolder folder;
  write_image(folder, "mav0/cam0/data/1403715273262142976.png", 1, 32, 24, true);
  write_image(folder, "mav0/cam0/data/1403715273312143104.png", 2, 32, 24, true);
  folder.write("mav0/cam0/data.csv",
               "#timestamp [ns],filename\r\n1403715273262142976,1403715273262142976.png\r\n"
               "1403715273312143104,1403715273312143104.png\r\n");
  folder.write("mav0/cam0/sensor.yaml",
               "%YAML:1.0\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -1.0, 0.0, 0.5,\n    1.0, "
               "0.0, 0.0, 0.5,\n"
               "    0.0, 0.0, 1.0, 0.5,\n    0.0, 0.0, 0.0, 1.0]\nrate_hz: 20\n");
  folder.write("mav0/state_groundtruth_estimate0/data.csv",
               "#t,px,py,pz,qw,qx,qy,qz,vx\n1403715273262142976,1,2,3,1,0,0,0,9\n"
               "1403715273312143104,nan,2,3,1,0,0,0,9\n");
  const std::string part = GENERATE(as<std::string>{}, "", "mav0");
  const std::string path = folder / part;
  const Source source = open_sequence(path);
  REQUIRE(std::string(source->format) == "euroc");
  const auto answers = play(source);
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].timestamp_ns == 1403715273262142976);
  REQUIRE(answers[1].timestamp_ns == 1403715273312143104);
  REQUIRE(answers[1].pixel == 2);
  REQUIRE(truth_of(source).size() == 1);
  require_quarter_turn(truth_of(source)[0]);
  REQUIRE(notes_of(source).find("1 poses left out") != std::string::npos);
}

TEST_CASE("euroc: without the csv the names are the times") {
  const TempFolder folder;
  write_image(folder, "mav0/cam0/data/1403715273262142976.png", 1);
  REQUIRE(play(open_sequence(folder.path()))[0].timestamp_ns == 1403715273262142976);
}

TEST_CASE("replica: frames and a matrix per line") {
  const TempFolder folder;
  write_image(folder, "results/frame000000.jpg", 1);
  write_image(folder, "results/frame000001.jpg", 2);
  write_image(folder, "results/depth000000.png", 3);
  folder.write("traj.txt",
               "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n0 -1 0 1.5 1 0 0 2.5 0 0 1 3.5 0 0 0 1\n");
  const Source source = open_sequence(folder.path());
  REQUIRE(std::string(source->format) == "replica");
  const auto answers = play(source);
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[1].timestamp_ns == 33333333);
  require_quarter_turn(truth_of(source)[1]);
  REQUIRE(truth_of(source)[1].timestamp_ns == 33333333);
}

TEST_CASE("images: folder or pattern in natural order") {
  const TempFolder folder;
  write_image(folder, "my images/img10.png", 10);
  write_image(folder, "my images/img9.PNG", 9);
  write_image(folder, "my images/img11.png", 11);
  folder.write("my images/readme.txt", "no image");
  const std::string part = GENERATE(as<std::string>{}, "my images", "my images/img*[gG]");
  const std::string path = folder / part;
  const Source source = open_sequence(path, nullptr, 0, 0, 25);
  REQUIRE(std::string(source->format) == "images");
  const auto answers = play(source);
  REQUIRE(answers.size() == 3);
  REQUIRE(answers[0].pixel == 9);
  REQUIRE(answers[1].pixel == 10);
  REQUIRE(answers[2].pixel == 11);
  REQUIRE(answers[2].timestamp_ns == 80000000);
  REQUIRE(truth_of(source).empty());
  REQUIRE(std::string(source->ground_truth_path(source.get())).empty());
}

TEST_CASE("a range keeps the positions and times of the whole sequence") {
  const TempFolder folder;
  for (int k = 0; k < 6; ++k) write_image(folder, std::to_string(k) + ".png", k);
  const Source source = open_sequence(folder.path(), "images", 2, 5, 10);
  REQUIRE(source->frame_count(source.get()) == 3);
  const auto answers = play(source);
  REQUIRE(answers.size() == 3);
  REQUIRE(answers[0].index == 2);
  REQUIRE(answers[0].timestamp_ns == 200000000);
  REQUIRE(answers[2].pixel == 4);
  REQUIRE(open_sequence(folder.path(), "images", 4, 100)->frame_count(source.get()) == 3);
}

TEST_CASE("a frame that is not to be decoded has its time and no image") {
  const TempFolder folder;
  for (int k = 0; k < 2; ++k) write_image(folder, std::to_string(k) + ".png", 50 + k);
  const Source source = open_sequence(folder.path());
  unisim_frame frame;
  REQUIRE(source->next_frame(source.get(), 0, &frame) == UNISIM_FRAME_OK);
  REQUIRE(frame.image.data == nullptr);
  REQUIRE(source->next_frame(source.get(), 1, &frame) == UNISIM_FRAME_OK);
  REQUIRE(frame.index == 1);
  REQUIRE(frame.image.data[0] == 51);
}

TEST_CASE("the image buffer is used again from frame to frame") {
  const TempFolder folder;
  for (int k = 0; k < 3; ++k) write_image(folder, std::to_string(k) + ".png", k);
  const auto answers = play(open_sequence(folder.path()));
  REQUIRE(answers[0].image.data == answers[1].image.data);
  REQUIRE(answers[1].image.data == answers[2].image.data);
}
