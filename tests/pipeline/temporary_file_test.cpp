// SPDX-License-Identifier: MIT
// Records on a file without a name: what comes back, and what happens where the disk ends.
#include "drivers/pipeline/temporary_file.hpp"

#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"

using unisim::pipeline::RecordFile;
using unisim::pipeline::TemporaryFile;

namespace {

struct Record {
  int64_t value = -7;
  int32_t tag = 0;
};

/// Files of this process may not grow beyond so many bytes.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

/// Puts, overwrites and skips records; all must come back.
void use(const std::string& folder) {
  RecordFile<Record> file(folder);
  for (int32_t k = 0; k < 100; ++k) file.append({k * k, k});
  for (int32_t k = 0; k < 100; k += 10) file.put(k, {-k, k});
  file.put(150, {1, 1});
  REQUIRE(file.size() == 151);
  for (int32_t k = 0; k < 100; ++k) REQUIRE(file.get(k).value == (k % 10 == 0 ? -k : k * k));
  CHECK(file.get(120).value == -7);
  CHECK(file.get(150).value == 1);
  CHECK(file.get(151).value == -7);
  CHECK(file.get(-1).value == -7);
}

}  // namespace

TEST_CASE("records come back from disk, and the folder shows no file") {
  const TempFolder folder;
  TemporaryFile open(folder.path());
  use(folder.path());
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("records stay in memory where there is no folder or no room on its disk") {
  const TempFolder folder;
  SECTION("no folder named") { use(""); }
  SECTION("folder that is not there") { use(folder / "none"); }
  SECTION("full disk") {
    const SmallDisk disk(1000);
    use(folder.path());
  }
}
