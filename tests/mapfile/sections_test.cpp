// SPDX-License-Identifier: MIT
// A map file is whole or not there, and says which part of it is damaged.
#include "drivers/mapfile/sections.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

namespace unisim::mapfile::test {

namespace fs = std::filesystem;

namespace {

std::vector<Section> example() {
  return {{"about", {1, 2, 3}}, {"session", Bytes(50, 7)}, {"predictor", Bytes(40, 9)}};
}

bool same(const std::vector<Section>& a, const std::vector<Section>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const Section& x, const Section& y) {
           return x.name == y.name && x.bytes == y.bytes;
         });
}

/// What is wrong with a file, "" for nothing.
std::string problem_of(const std::string& path) {
  try {
    read_sections(path);
    return "";
  } catch (const Error& error) {
    CHECK(error.kind() == Error::Kind::kInput);
    return error.what();
  }
}

size_t files_in(const TempFolder& folder) {
  return static_cast<size_t>(std::distance(fs::directory_iterator(folder.path()), {}));
}

}  // namespace

TEST_CASE("parts come back as they were written") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  write_sections(path, example());
  CHECK(same(read_sections(path), example()));
  write_sections(path, {{"about", {}}});
  CHECK(same(read_sections(path), {{"about", {}}}));
  CHECK(files_in(folder) == 1);
}

TEST_CASE("a map file cut at any byte is refused by the name of the part") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  write_sections(path, example());
  const std::string whole = read_file(path);
  const size_t head = whole.size() - 93;
  for (size_t size = 0; size < whole.size(); ++size) {
    const std::string problem = problem_of(folder.write("cut.map", whole.substr(0, size)));
    const char* part = size >= head + 53  ? "part predictor"
                       : size >= head + 3 ? "part session"
                       : size >= head     ? "part about"
                       : size == 0        ? "is empty"
                       : size < 16        ? "its head is cut off"
                                          : "its head is cut off";
    INFO(size << ": " << problem);
    CHECK(has(problem, part));
    CHECK(has(problem, folder / "cut.map"));
  }
}

TEST_CASE("a map file with any byte flipped is refused by the name of the part") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  write_sections(path, example());
  const std::string whole = read_file(path);
  const size_t head = whole.size() - 93;
  for (size_t at = 0; at < whole.size(); ++at) {
    for (const int bit : {0, 7}) {
      std::string bad = whole;
      bad[at] = static_cast<char>(bad[at] ^ (1 << bit));
      const std::string problem = problem_of(folder.write("bad.map", bad));
      const char* part = at >= head + 53  ? "part predictor is damaged"
                         : at >= head + 3 ? "part session is damaged"
                         : at >= head     ? "part about is damaged"
                         : at < 8         ? "no map of libunisim"
                                          : "its head";
      INFO(at << ": " << problem);
      CHECK(has(problem, part));
    }
  }
}

TEST_CASE("files that are no maps say so") {
  const TempFolder folder;
  CHECK(has(problem_of(folder / "absent.map"), "no such map"));
  CHECK(has(problem_of(folder.path()), "is no file"));
  CHECK(
      has(problem_of(folder.write("text", "to be or not to be, that is")), "no map of libunisim"));
  write_sections(folder / "room.map", example());
  const std::string whole = read_file(folder / "room.map");
  CHECK(has(problem_of(folder.write("long", whole + "x")), "1 bytes after its last part"));
  std::string newer = whole;
  newer[8] = 2;
  CHECK(has(problem_of(folder.write("newer", newer)), "version 2"));
}

TEST_CASE("a map that does not fit on the disk leaves the old one") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  write_sections(path, example());
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit most = {4096, 4096};
    bool failed = false;
    try {
      if (setrlimit(RLIMIT_FSIZE, &most) == 0) write_sections(path, {{"session", Bytes(9999, 1)}});
    } catch (const Error& error) {
      failed = error.kind() == Error::Kind::kDevice && has(error.what(), "room.map");
    }
    _exit(failed ? 0 : 1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  CHECK(same(read_sections(path), example()));
  CHECK(files_in(folder) == 1);
}

TEST_CASE("killed at any time while it writes, a program leaves the old map or the new one") {
  const TempFolder folder;
  const std::string path = folder / "room.map";
  write_sections(path, {{"session", Bytes(1 << 20, 0)}});
  for (int round = 0; round < 20; ++round) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      for (uint8_t k = 1;; ++k) write_sections(path, {{"session", Bytes(1 << 20, k)}});
    }
    usleep(static_cast<useconds_t>(700 + 1931 * round % 9000));
    REQUIRE(kill(child, SIGKILL) == 0);
    REQUIRE(waitpid(child, nullptr, 0) == child);
    const std::vector<Section> found = read_sections(path);
    REQUIRE(found.size() == 1);
    CHECK(found[0].bytes == Bytes(1 << 20, found[0].bytes[0]));
  }
  // What the killed ones left goes with the next that is saved.
  write_sections(path, example());
  CHECK(files_in(folder) == 1);
}

TEST_CASE("a link keeps pointing to the map") {
  const TempFolder folder;
  write_sections(folder / "room.map", {{"about", {1}}});
  fs::create_symlink(folder / "room.map", folder / "newest.map");
  write_sections(folder / "newest.map", example());
  CHECK(fs::is_symlink(folder / "newest.map"));
  CHECK(same(read_sections(folder / "room.map"), example()));
}

TEST_CASE("where no map can be written is known before") {
  const TempFolder folder;
  CHECK_NOTHROW(check_writable(folder / "room.map"));
  CHECK(files_in(folder) == 0);
  CHECK_THROWS_AS(check_writable(folder / "absent/room.map"), Error);
  CHECK_THROWS_AS(check_writable(folder.path()), Error);
  CHECK_THROWS_AS(check_writable(folder.path() + "/"), Error);
  CHECK_THROWS_AS(check_writable("/dev/null"), Error);
}

}  // namespace unisim::mapfile::test
