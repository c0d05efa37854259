// SPDX-License-Identifier: MIT
// A recording that cannot be written stops alone; the run goes on.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <memory>

#include "drivers/recorded/recorded.h"
#include "tests/recorded/scripted_predictor.hpp"
#include "tests/recorded/transcript.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::test;

namespace {

/// Files of this process may not grow beyond a size, as on a full disk, until the end of the scope.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("a full disk stops the recording, not the run") {
  if (access("/dev/full", W_OK) != 0) {
    WARN("skipped: no /dev/full");
    return;
  }
  unisim_predictor* plain = make_scripted_predictor();
  const Transcript expected = run_predictor(plain);
  plain->destroy(plain);
  char message[300];
  unisim_predictor* recorder = unisim_recorder_create(make_scripted_predictor(), "/dev/full",
                                                      "sequence", message, sizeof message);
  REQUIRE(recorder != nullptr);
  CHECK(run_predictor(recorder).answers == expected.answers);
  const std::string problem = unisim_recorder_problem(recorder);
  CHECK(has(problem, "/dev/full: recording stopped after 0 records: No space left on device"));
  CHECK_FALSE(has(problem, "\n"));
  recorder->destroy(recorder);
}

TEST_CASE("what was written before the disk was full stays readable") {
  const TempFolder folder;
  const std::string path = folder.file("run.usr");
  Transcript expected;
  {
    const FileSizeLimit limit(5000);
    char message[300];
    unisim_predictor* recorder = unisim_recorder_create(make_scripted_predictor(), path.c_str(),
                                                        "sequence", message, sizeof message);
    REQUIRE(recorder != nullptr);
    expected = run_predictor(recorder);
    CHECK(has(unisim_recorder_problem(recorder), "recording stopped after"));
    recorder->destroy(recorder);
  }
  CHECK(read_bytes(path).size() <= 5000);
  char message[300];
  unisim_predictor* recorded = unisim_recorded_open(path.c_str(), message, sizeof message);
  REQUIRE(recorded != nullptr);
  CHECK(has(message, "cut off"));
  const Transcript repeated = run_predictor(recorded);
  recorded->destroy(recorded);
  size_t equal = 0;
  while (repeated.answers[equal] == expected.answers[equal]) ++equal;
  CHECK(equal > 10);
}

TEST_CASE(
    "a recording in a folder that is not there is refused, the predictor stays the caller's") {
  const TempFolder folder;
  unisim_predictor* inner = make_scripted_predictor();
  char message[300];
  CHECK(unisim_recorder_create(inner, folder.file("no/such.usr").c_str(), "", message, 300) ==
        nullptr);
  CHECK(has(message, "such.usr: cannot be written: No such file or directory"));
  inner->destroy(inner);
}
