// SPDX-License-Identifier: MIT
// Lists of images in the spellings that people have, in any order and unit.
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace {

// Two images of brightness 10 and 20 that the list must name at 1.5 s and 1.6 s.
struct TwoImages {
  TwoImages() {
    write_image(folder, "rgb/a 1.png", 10);
    write_image(folder, "rgb/a 2.png", 20);
  }
  TempFolder folder;

  Source require_read(int64_t first_ns = 1500000000, int64_t second_ns = 1600000000) {
    Source source = open_sequence(folder.path());
    const auto answers = play(source);
    REQUIRE(answers.size() == 2);
    REQUIRE(answers[0].pixel == 10);
    REQUIRE(answers[1].pixel == 20);
    REQUIRE(answers[0].timestamp_ns == first_ns);
    REQUIRE(answers[1].timestamp_ns == second_ns);
    return source;
  }
};

void write_depth(const TempFolder& folder, const std::string& name) {
  folder.make_parent(name);
  REQUIRE(cv::imwrite(folder / name, cv::Mat(24, 32, CV_16UC1, cv::Scalar(5000))));
}

}  // namespace

TEST_CASE("tum: a list in any spelling gives the same images and times") {
  const std::string list = GENERATE(as<std::string>{},                                 //
                                    "1.5 rgb/a 1.png\n1.6 rgb/a 2.png\n",              //
                                    "1.6 rgb/a 2.png\n1.5 rgb/a 1.png\n",              //
                                    "1.5 rgb/a 1.png 0 0\n1.6 rgb/a 2.png 7 x\n",      //
                                    "1.5 \"rgb/a 1.png\"\n1.6 'rgb/a 2.png'\n",        //
                                    "1.5,rgb/a 1.png\r\n1.6, rgb/a 2.png,3\r\n",       //
                                    "1.5;rgb/a 1.png\n1.6;\"rgb/a 2.png\";\n",         //
                                    "\"1.5\"\t\"rgb/a 1.png\"\n1.6\t./rgb/a 2.png\n",  //
                                    "1.5 a 1.png\n1.6 rgb\\a 2.png\n",                 //
                                    "1500 rgb/a 1.png\n1600 rgb/a 2.png\n",            //
                                    "1500000 rgb/a 1.png\n1600000 rgb/a 2.png\n",      //
                                    "1500000000 rgb/a 1.png\n1600000000 rgb/a 2.png\n");
  INFO(list);
  TwoImages images;
  images.folder.write("rgb.txt", list);
  images.require_read();
}

TEST_CASE("tum: absolute names are taken as they are") {
  TwoImages images;
  const std::string base = images.folder / "rgb/a ";
  images.folder.write("rgb.txt", "1.5 " + base + "1.png\n1.6 " + base + "2.png\n");
  images.require_read();
}

TEST_CASE("tum: names without ending are found") {
  const TempFolder folder;
  write_image(folder, "rgb/7.png", 10);
  folder.write("rgb.txt", "1.5 rgb/7 9\n");
  REQUIRE(play(open_sequence(folder.path()))[0].pixel == 10);
}

TEST_CASE("tum: of colour and depth the colour is read, whatever the order and the folders") {
  const bool depth_first = GENERATE(true, false);
  const std::string prefix = GENERATE(as<std::string>{}, "./", "", "/depth_tests/");
  const std::string depth_folder = GENERATE("depth", "aligned_Depth", "d");
  TwoImages images;
  const bool absolute = prefix[0] == '/';
  std::string base = prefix;
  if (absolute) base = images.folder / "";
  std::string list;
  for (int k = 1; k <= 2; ++k) {
    const std::string number = std::to_string(k);
    const std::string depth_name = depth_folder + "/" + number + ".png";
    write_depth(images.folder, depth_name);
    const std::string colour =
        "1." + std::to_string(4 + k) + " " + base + "rgb/a " + number + ".png";
    const std::string depth = "1." + std::to_string(4 + k) + "1 " + base + depth_name;
    list += (depth_first ? depth + " " + colour : colour + " " + depth) + " 0\n";
  }
  INFO(list);
  images.folder.write("associations.txt", list);
  images.require_read();
}

TEST_CASE("a recorded list is sorted by time and repeated lines are left out, which is told") {
  const bool decode = GENERATE(true, false);
  const TempFolder folder;
  for (const char* name : {"a.png", "b.png", "c.png"}) write_image(folder, name, name[0]);
  folder.write("rgb.txt",
               "0.3 c.png\n0.1 a.png\n0.1 a.png\n0.2 b.png\n0.20 b.png\n0.2 c.png\n0.1 a.png\n");
  const Source source = open_sequence(folder.path());
  const auto answers = play(source, decode);
  REQUIRE(answers.size() == 3);
  for (int k = 0; k < 3; ++k) {
    REQUIRE(answers[static_cast<size_t>(k)].status == UNISIM_FRAME_OK);
    REQUIRE(answers[static_cast<size_t>(k)].index == k);
    REQUIRE(answers[static_cast<size_t>(k)].timestamp_ns == 100000000 * (k + 1));
    if (decode) REQUIRE(answers[static_cast<size_t>(k)].pixel == 'a' + k);
  }
  const std::string notes = notes_of(source);
  REQUIRE(has(notes, "rgb.txt: not in the order of time: sorted"));
  REQUIRE(has(notes, "1 of 4 images have the time of another (first: b.png and c.png at 0.2"));
  REQUIRE(has(notes, "3 repeated lines left out"));
}

TEST_CASE("a list in which most images have the time of another is refused") {
  const TempFolder folder;
  std::string list;
  for (int k = 0; k < 12; ++k) {
    const std::string name = std::to_string(k) + ".png";
    write_image(folder, name, k);
    list += std::to_string(1305031102 + k / 4) + " " + name + "\n";
  }
  folder.write("rgb.txt", list);
  const std::string message = open_failure(folder.path());
  REQUIRE(has(message, folder / "rgb.txt: 9 of 12 images have the time of another"));
  REQUIRE(has(message, "0.png and 1.png"));
  REQUIRE(has(message, "give each image a time of its own"));
}

TEST_CASE("euroc: a csv in any spelling gives the same images and times") {
  const std::string a = "1403715273262142976";
  const std::string b = "1403715273312143104";
  const std::string list = GENERATE_COPY(               //
      a + "," + a + ".png\n" + b + "," + b + ".png\n",  //
      b + "," + b + ".png\n" + a + "," + a + ".png\n",  //
      "\xEF\xBB\xBF#timestamp [ns],filename\r\n" + a + "," + a + ".png\r\n" + b + "," + b +
          ".png\r\n",                                                                    //
      a + "," + a + ".png,0.01\n" + b + "," + b + ".png,0.01\n",                         //
      a + "," + a + "\n" + b + "," + b + "\n",                                           //
      a + "," + a + ",0.01\n" + b + "," + b + ",0.01\n",                                 //
      a + " " + a + ".png\n" + b + " " + b + ".png\n",                                   //
      a + ",data/" + a + ".png\n" + b + ",cam0/data/" + b + ".png\n",                    //
      "timestamp,filename\n" + a + ",\"" + a + ".png\"\n" + b + ",\"" + b + ".png\"\n",  //
      "1403715273.262142976," + a + ".png\n1403715273.312143104," + b + ".png\n");
  INFO(list);
  const TempFolder folder;
  write_image(folder, "mav0/cam0/data/" + a + ".png", 1);
  write_image(folder, "mav0/cam0/data/" + b + ".png", 2);
  folder.write("mav0/cam0/data.csv", list);
  const auto answers = play(open_sequence(folder.path()));
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].timestamp_ns == 1403715273262142976);
  REQUIRE(answers[1].timestamp_ns == 1403715273312143104);
  REQUIRE(answers[0].pixel == 1);
  REQUIRE(answers[1].pixel == 2);
}

TEST_CASE("euroc: names that are times may be in seconds, and other names are counted") {
  const TempFolder folder;
  write_image(folder, "mav0/cam0/data/1403715273.262142.png", 1);
  write_image(folder, "mav0/cam0/data/1403715273.312143.png", 2);
  write_image(folder, "mav0/cam0/data/overview.png", 2);
  const Source source = open_sequence(folder.path());
  const auto answers = play(source);
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[1].timestamp_ns == 1403715273312143000);
  REQUIRE(has(notes_of(source), "times are read as seconds"));
  REQUIRE(has(notes_of(source), "1 images left out"));
}

TEST_CASE("hidden files are no input, in any format") {
  const TempFolder folder;
  const auto hide = [&](const std::string& name) { folder.write(name, "Mac OS X"); };
  const auto require_frames = [&](const std::string& name, size_t frames, size_t poses) {
    INFO(name);
    const Source source = open_sequence(folder / name);
    const auto answers = play(source);
    REQUIRE(answers.size() == frames);
    for (const Answer& answer : answers) REQUIRE(answer.status == UNISIM_FRAME_OK);
    REQUIRE(truth_of(source).size() == poses);
  };
  write_image(folder, "images/1.png", 1);
  hide("images/._1.png");
  hide("images/.hidden.png");
  require_frames("images", 1, 0);
  require_frames("images/*.png", 1, 0);
  write_image(folder, "tum/rgb/1.png", 1);
  hide("tum/rgb/._1.png");
  folder.write("tum/rgb.txt", "0.1 rgb/1.png\n0.2 rgb/._1.png\n");
  require_frames("tum", 1, 0);
  write_image(folder, "7/seq-01/frame-000001.color.png", 1);
  hide("7/._seq-01");
  hide("7/seq-01/._frame-000001.color.png");
  require_frames("7", 1, 0);
  write_image(folder, "euroc/mav0/cam0/data/1403715273262142976.png", 1);
  hide("euroc/mav0/cam0/data/._1403715273262142976.png");
  require_frames("euroc", 1, 0);
  write_image(folder, "kitti/sequences/06/image_0/000000.png", 1);
  hide("kitti/sequences/06/image_0/._000000.png");
  hide("kitti/sequences/.DS_Store");
  folder.write("kitti/poses/06.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  hide("kitti/poses/._06.txt");
  require_frames("kitti", 1, 1);
  write_image(folder, "replica/results/frame000000.jpg", 1);
  hide("replica/results/._frame000000.jpg");
  folder.write("replica/traj.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  require_frames("replica", 1, 1);
  hide("only/._1.png");
  REQUIRE(has(open_failure(folder / "only"), "empty folder"));
}
