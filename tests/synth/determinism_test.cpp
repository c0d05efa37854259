// SPDX-License-Identifier: MIT
// The same options give the same bytes, whatever the number of threads.
#include <map>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/synth/sequence.hpp"

namespace {

using unisim::synth::SequenceOptions;

std::map<std::string, std::string> bytes_of(const SequenceOptions& options) {
  unisim::synth::write_sequence(options, [](int) {});
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(options.folder)) {
    if (entry.is_regular_file()) {
      files[entry.path().lexically_relative(options.folder).string()] =
          read_file(entry.path().string());
    }
  }
  return files;
}

SequenceOptions small() {
  SequenceOptions options;
  options.scene = "lowtexture";
  options.frames = 4;
  options.width = 96;
  options.height = 64;
  options.noise = true;
  options.blur = true;
  options.exposure_jumps = true;
  return options;
}

}  // namespace

TEST_CASE("a sequence does not depend on the number of threads") {
  const TempFolder folder;
  SequenceOptions options = small();
  options.folder = folder / "one";
  options.threads = 1;
  const auto one = bytes_of(options);
  options.folder = folder / "three";
  options.threads = 3;
  const auto three = bytes_of(options);
  REQUIRE(one.size() == 5 + 2 * 4);
  CHECK(one == three);
}

TEST_CASE("another seed gives other images and another path") {
  const TempFolder folder;
  SequenceOptions options = small();
  options.folder = folder / "one";
  const auto one = bytes_of(options);
  options.folder = folder / "two";
  options.seed = 2;
  const auto two = bytes_of(options);
  CHECK(one.at("groundtruth.txt") != two.at("groundtruth.txt"));
  CHECK(one.at("rgb/1000.000000.png") != two.at("rgb/1000.000000.png"));
}
