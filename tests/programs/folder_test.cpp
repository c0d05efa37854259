// SPDX-License-Identifier: MIT
// One run at a time in a folder.

#include <filesystem>

#include "tests/programs/shell.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/folder_lock.hpp"

using unisim::tools::Failure;
using unisim::tools::FolderLock;

TEST_CASE("a folder is held once, until its holder is gone") {
  const TempFolder folder;
  {
    const FolderLock first(folder.path());
    CHECK_THROWS_AS(FolderLock(folder.path()), Failure);
  }
  CHECK_NOTHROW(FolderLock(folder.path()));
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a sequence is not rendered into the folder of another run") {
  unisim::testing::Shell shell;
  std::filesystem::create_directory(shell.folder() / "out");
  const FolderLock other(shell.folder() / "out");
  CHECK(shell.run("synth", "out --scene lowtexture --size 64x48 --frames 1 --force") == 2);
  CHECK(has(shell.err, "out: another run writes there"));
  CHECK(std::filesystem::is_empty(shell.folder() / "out"));
}
