// SPDX-License-Identifier: MIT
// What is wrong with a sequence is said in one line; what is wrong with a frame does not stop the
// run.
#include <unistd.h>

#include <filesystem>
#include <iterator>

#include "tests/readers/playback.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace {

// Keeps the first `share` of a file.
void cut_file(const std::string& path, double share) {
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::resize_file(path, static_cast<uintmax_t>(bytes * share));
}

// Three images, the middle one to be spoilt.
struct ThreeImages {
  explicit ThreeImages(const std::string& ending) : middle("1" + ending) {
    for (int k = 0; k < 3; ++k) write_image(folder, std::to_string(k) + ending, 40 + k, 64, 48);
  }
  TempFolder folder;
  std::string middle;

  std::string require_middle_bad() {
    std::vector<Answer> answers;
    const std::string noise = stderr_of([&] { answers = play(open_sequence(folder.path())); });
    REQUIRE(noise.empty());
    REQUIRE(answers.size() == 3);
    REQUIRE(answers[0].status == UNISIM_FRAME_OK);
    REQUIRE(answers[1].status == UNISIM_FRAME_BAD);
    REQUIRE(answers[1].image.data == nullptr);
    REQUIRE(answers[2].status == UNISIM_FRAME_OK);
    REQUIRE(answers[2].index == 2);
    REQUIRE(has(answers[1].message, "frame 1"));
    REQUIRE(has(answers[1].message, folder / middle));
    REQUIRE(has(answers[1].message, "skipped"));
    return answers[1].message;
  }
};

}  // namespace

TEST_CASE("a truncated image is a bad frame") {
  const std::string ending = GENERATE(".png", ".jpg");
  const double share = GENERATE(0.9, 0.5, 0.1);
  ThreeImages images(ending);
  cut_file(images.folder / images.middle, share);
  REQUIRE(has(images.require_middle_bad(), "truncated"));
}

TEST_CASE("an empty image is a bad frame") {
  ThreeImages images(".png");
  images.folder.write(images.middle, "");
  REQUIRE(has(images.require_middle_bad(), "is empty"));
}

TEST_CASE("a file that is no image is a bad frame") {
  ThreeImages images(".png");
  images.folder.write(images.middle, "this is text");
  REQUIRE(has(images.require_middle_bad(), "not an image"));
}

TEST_CASE("a damaged image is a bad frame") {
  ThreeImages images(".png");
  const std::string path = images.folder / images.middle;
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path) / 2));
  file << "damage";
  file.close();
  const auto answers = play(open_sequence(images.folder.path()));
  REQUIRE(answers[1].status == UNISIM_FRAME_BAD);
  REQUIRE(answers[2].status == UNISIM_FRAME_OK);
}

TEST_CASE("a folder with the name of an image is a bad frame") {
  ThreeImages images(".png");
  std::filesystem::remove(images.folder / images.middle);
  std::filesystem::create_directory(images.folder / images.middle);
  REQUIRE(has(images.require_middle_bad(), "cannot be read"));
}

TEST_CASE("an image of another size is a bad frame and both sizes are said") {
  ThreeImages images(".png");
  write_image(images.folder, images.middle, 1, 32, 24);
  const std::string message = images.require_middle_bad();
  REQUIRE(has(message, "32x24"));
  REQUIRE(has(message, "64x48"));
}

TEST_CASE("a listed image that is missing is a bad frame") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  folder.write("rgb.txt", "0.1 missing.png\n0.2 a.png\n");
  const auto answers = play(open_sequence(folder.path()));
  REQUIRE(answers.size() == 2);
  REQUIRE(answers[0].status == UNISIM_FRAME_BAD);
  REQUIRE(has(answers[0].message, "No such file"));
  REQUIRE(answers[1].status == UNISIM_FRAME_OK);
}

TEST_CASE("where pixels are welcome but not needed a missing image is a frame without them") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  folder.write("rgb.txt", "0.1 missing.png\n0.2 a.png\n");
  const Source source = open_sequence(folder.path());
  unisim_frame frame{};
  REQUIRE(source->next_frame(source.get(), UNISIM_DECODE_IF_READABLE, &frame) == UNISIM_FRAME_OK);
  CHECK(frame.image.data == nullptr);
  CHECK(frame.index == 0);
  CHECK(frame.timestamp_ns == 100000000);
  CHECK(has(source->message(source.get()), "missing.png: cannot be read: No such file"));
  REQUIRE(source->next_frame(source.get(), UNISIM_DECODE_IF_READABLE, &frame) == UNISIM_FRAME_OK);
  CHECK(frame.image.data != nullptr);
}

TEST_CASE("lines of a list that are not 'time name' are counted, the first is told") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  folder.write("rgb.txt", "0.1 a.png\nsoon a.png\n0.2 a.png\n0.3\nnan a.png\n0.4 a.png\n");
  const Source source = open_sequence(folder.path());
  REQUIRE(source->frame_count(source.get()) == 3);
  REQUIRE(has(notes_of(source), "rgb.txt:2: 'soon a.png' is not 'time name': 3 of 6 lines"));
}

TEST_CASE("a list of which less than half is understood is refused with file, line and form") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  folder.write("rgb.txt", "# c\n0.1 a.png\na.png 0.2\na.png 0.3\n");
  const std::string message = open_failure(folder.path());
  REQUIRE(has(message, folder / "rgb.txt:3: 'a.png 0.2' is not 'time name'"));
  REQUIRE(has(message, "expected a time and the name of an image"));
}

TEST_CASE("a text file in UTF-16 is told") {
  const TempFolder folder;
  folder.write("rgb.txt", std::string("\xFF\xFE") + std::string("0\0 \0a\0", 6));
  REQUIRE(has(open_failure(folder.path()), "save it as UTF-8"));
}

TEST_CASE("a ground truth of no use leaves the images readable") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  folder.write("rgb.txt", "0.2 a.png\n");
  folder.write("groundtruth.txt", "# time pose\nnan nan nan nan 0 0 0 1\n");
  const Source source = open_sequence(folder.path());
  REQUIRE(play(source).size() == 1);
  REQUIRE(truth_of(source).empty());
  REQUIRE(std::string(source->ground_truth_path(source.get())).empty());
  REQUIRE(has(notes_of(source), "no ground truth"));
}

TEST_CASE("paths that cannot be a sequence") {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "empty");
  folder.write("text/notes.txt", "nothing here");
  folder.write("listed/rgb.txt", "# only a comment\n");
  folder.write("log.txt", "plain text");
  folder.write("zero.mp4", "");
  folder.write("noise.mp4", std::string(5000, '\x01'));
  REQUIRE(has(open_failure(folder / "nowhere"), "no such folder or file"));
  REQUIRE(has(open_failure(""), "no path given"));
  REQUIRE(has(open_failure(folder / "empty"), "empty folder"));
  const std::string unknown = open_failure(folder / "text");
  for (const char* sign :
       {"rgb.txt", "frame-*.color", "mav0/cam0", "image_0", "results/frame", "video", "png"}) {
    REQUIRE(has(unknown, sign));
  }
  REQUIRE(has(open_failure(folder / "listed"), "nothing to read"));
  REQUIRE(has(open_failure(folder / "log.txt"), "text file"));
  REQUIRE(has(open_failure(folder / "zero.mp4"), "empty"));
  REQUIRE(has(open_failure(folder / "no*.png"), "no image"));
  std::string message;
  REQUIRE(stderr_of([&] { message = open_failure(folder / "noise.mp4"); }).empty());
  REQUIRE(has(message, "not a video"));
}

TEST_CASE("a named format that does not fit says what it needs") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  REQUIRE(has(open_failure(folder.path(), "tum"), "rgb.txt"));
  REQUIRE(has(open_failure(folder.path(), "7scenes"), "frame-*.color"));
  REQUIRE(has(open_failure(folder.path(), "euroc"), "mav0"));
  REQUIRE(has(open_failure(folder.path(), "kitti"), "image_0"));
  REQUIRE(has(open_failure(folder.path(), "replica"), "results/frame"));
  REQUIRE(has(open_failure(folder.path(), "video"), "video file"));
  const std::string unknown = open_failure(folder.path(), "rosbag");
  REQUIRE(has(unknown, "rosbag"));
  REQUIRE(has(unknown, "7scenes"));
}

TEST_CASE("ranges and options out of bounds are refused") {
  const TempFolder folder;
  write_image(folder, "a.png", 1);
  REQUIRE(has(open_failure(folder.path(), nullptr, 1), "has 1 frames"));
  REQUIRE(has(open_failure(folder.path(), nullptr, -1), "negative"));
  REQUIRE(has(open_failure(folder.path(), nullptr, 5, 5), "[5, 5)"));
  unisim_sequence_options options{};
  char message[200];
  REQUIRE(unisim_sequence_open(folder.path().c_str(), &options, message, sizeof message) ==
          nullptr);
  REQUIRE(has(message, "struct_size"));
  REQUIRE(unisim_sequence_open(nullptr, nullptr, nullptr, 0) == nullptr);
}

TEST_CASE("a message longer than its buffer is cut and ended") {
  char message[8] = "xxxxxxx";
  REQUIRE(unisim_sequence_open("/nowhere/at/all", nullptr, message, sizeof message) == nullptr);
  REQUIRE(std::string(message) == "/nowher");
}

TEST_CASE("kitti: too few times are an error") {
  const TempFolder folder;
  for (int k = 0; k < 3; ++k) write_image(folder, "image_0/" + std::to_string(k) + ".png", k);
  folder.write("times.txt", "0.0\n0.1\n");
  REQUIRE(has(open_failure(folder.path()), "2 lines for 3 images numbered 0 to 2"));
}

TEST_CASE("a folder that may not be read") {
  if (geteuid() == 0) {
    WARN("skipped: root may read everything");
    return;
  }
  const TempFolder folder;
  write_image(folder, "locked/a.png", 1);
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::none);
  REQUIRE(has(open_failure(folder / "locked"), "Permission denied"));
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_all);
}
