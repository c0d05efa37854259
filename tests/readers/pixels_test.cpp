// SPDX-License-Identifier: MIT
// What an image file says about its pixels holds for the whole sequence: turning and bit depth.
#include <opencv2/imgcodecs.hpp>

#include "tests/readers/playback.hpp"
#include "tests/readers/tagged_image.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

namespace {

// Size and the corner that is bright, such as "48x32 upper left".
std::string layout(const unisim_image& image) {
  const auto bright = [&](int32_t x, int32_t y) {
    return image.data[y * image.stride + x * image.format] > 128;
  };
  const std::string size = std::to_string(image.width) + "x" + std::to_string(image.height);
  if (bright(2, 2)) return size + " upper left";
  if (bright(image.width - 3, 2)) return size + " upper right";
  if (bright(2, image.height - 3)) return size + " lower left";
  return size + " lower right";
}

std::vector<std::string> layouts(const TempFolder& folder) {
  const Source source = open_sequence(folder.path());
  std::vector<std::string> found;
  unisim_frame frame;
  for (int status; (status = source->next_frame(source.get(), 1, &frame)) != UNISIM_FRAME_END;) {
    found.push_back(status == UNISIM_FRAME_OK ? layout(frame.image)
                                              : source->message(source.get()));
  }
  return found;
}

void write_deep_image(const TempFolder& folder, const std::string& name, int value,
                      int type = CV_16UC1) {
  folder.make_parent(name);
  cv::Mat image(24, 32, type, cv::Scalar::all(0));
  image(cv::Rect(0, 0, 4, 4)).setTo(cv::Scalar::all(value));
  REQUIRE(cv::imwrite(folder / name, image));
}

std::vector<int> first_pixels(const Source& source) {
  std::vector<int> pixels;
  for (const Answer& answer : play(source)) pixels.push_back(answer.pixel);
  return pixels;
}

}  // namespace

TEST_CASE("an orientation that all images name turns them upright") {
  const std::string ending = GENERATE(".jpg", ".png", ".webp", ".tif");
  const TempFolder folder;
  write_tagged_image(folder, "a" + ending, 6);
  write_tagged_image(folder, "b" + ending, 6);
  CHECK(layouts(folder) == std::vector<std::string>(2, "32x48 upper right"));
}

TEST_CASE("every orientation turns as EXIF says") {
  const char* const expected[] = {"48x32 upper left",  "48x32 upper right", "48x32 lower right",
                                  "48x32 lower left",  "32x48 upper left",  "32x48 upper right",
                                  "32x48 lower right", "32x48 lower left"};
  const std::string ending = GENERATE(".jpg", ".tif");
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const TempFolder folder;
    write_tagged_image(folder, "a" + ending, orientation);
    CHECK(layouts(folder) == std::vector<std::string>(1, expected[orientation - 1]));
  }
}

TEST_CASE("an orientation that changes on the way is that of the first image") {
  const std::string ending = GENERATE(".jpg", ".png", ".webp", ".tif");
  const TempFolder folder;
  const int first = GENERATE(1, 6);
  const int others[] = {first, 3, 6, 0, 8};
  for (int k = 0; k < 5; ++k) write_tagged_image(folder, std::to_string(k) + ending, others[k]);
  CHECK(layouts(folder) == std::vector<std::string>(5, layouts(folder)[0]));
  CHECK(layouts(folder)[0] == (first == 1 ? "48x32 upper left" : "32x48 upper right"));
}

TEST_CASE("the first image that can be read decides the orientation") {
  const TempFolder folder;
  folder.write("0.jpg", "");
  write_tagged_image(folder, "1.jpg", 6);
  write_tagged_image(folder, "2.jpg", 1);
  const auto found = layouts(folder);
  CHECK(has(found[0], "empty"));
  CHECK(found[1] == "32x48 upper right");
  CHECK(found[2] == found[1]);
}

TEST_CASE("an orientation beyond 8 or behind the end of its block turns nothing") {
  const TempFolder folder;
  write_tagged_image(folder, "0.jpg", 200);
  CHECK(layouts(folder)[0] == "48x32 upper left");
}

TEST_CASE("12 bits in 16-bit images are seen as such, the same in each image") {
  const int type = GENERATE(CV_16UC1, CV_16UC3);
  const std::string ending = GENERATE(".png", ".tiff");
  const TempFolder folder;
  write_deep_image(folder, "0" + ending, 2600, type);
  write_deep_image(folder, "1" + ending, 4095, type);
  write_deep_image(folder, "2" + ending, 160, type);
  const Source source = open_sequence(folder.path());
  CHECK(has(notes_of(source), "12 bits"));
  CHECK(first_pixels(source) == std::vector<int>{2600 >> 4, 255, 10});
}

TEST_CASE("brighter images further on tell the bit depth too, and what is beyond it is white") {
  const TempFolder folder;
  const int values[] = {60, 100, 4000, 100, 20000};
  for (int k = 0; k < 5; ++k) write_deep_image(folder, std::to_string(k) + ".png", values[k]);
  CHECK(first_pixels(open_sequence(folder.path())) == std::vector<int>{0, 0, 15, 0, 78});
  CHECK(first_pixels(open_sequence(folder.path(), nullptr, 0, 3))[2] == 250);
}

TEST_CASE("16-bit images of dark pixels alone are not black") {
  const TempFolder folder;
  write_deep_image(folder, "0.png", 200);
  CHECK(first_pixels(open_sequence(folder.path())) == std::vector<int>{200});
}

TEST_CASE("images of 16 and of 8 bits are as they were, without a word") {
  const TempFolder folder;
  write_deep_image(folder, "deep/0.png", 65535);
  write_deep_image(folder, "deep/1.png", 32768);
  write_image(folder, "plain/0.png", 77);
  const Source deep = open_sequence(folder / "deep");
  CHECK(first_pixels(deep) == std::vector<int>{255, 128});
  CHECK(notes_of(deep).empty());
  CHECK(first_pixels(open_sequence(folder / "plain")) == std::vector<int>{77});
}

TEST_CASE("depth maps given as images are refused by name of file or folder") {
  const TempFolder folder;
  write_deep_image(folder, "sequence/depth/0.png", 5000);
  write_deep_image(folder, "maps/depth_000.png", 5000);
  write_deep_image(folder, "frames/frame-000000.depth.png", 5000);
  for (const char* name : {"sequence/depth", "maps", "frames"}) {
    const std::string message = open_failure(folder / name);
    CHECK(has(message, "depth map"));
    CHECK(has(message, "colour"));
  }
  write_deep_image(folder, "in_depth/rgb/0.png", 5000);
  write_deep_image(folder, "colour_depth/0.png", 5000, CV_16UC3);
  write_image(folder, "shown/depth.png", 9, 32, 24, true);
  for (const char* name : {"in_depth/rgb", "colour_depth", "shown"}) open_sequence(folder / name);
}
