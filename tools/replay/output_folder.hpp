// SPDX-License-Identifier: MIT
// The folder of results: checked before the work starts and held for one run; files appear in it
// whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/common/folder_lock.hpp"

namespace unisim::replay {

class OutputFolder {
 public:
  /// Makes the folder, holds it and checks that it can be written. Throws Failure: not a folder or
  /// not writable (3), no space (4), another run holds it or one of `names` is there and `force` is
  /// not given (2).
  OutputFolder(const std::string& path, const std::vector<std::string>& names, bool force);

  /// Writes a file through `write`, which gets the path to write to and throws on failure. The file
  /// takes its name only when it is complete, and without `force` only if nothing has taken it
  /// since. Failures are kept, not thrown: later files still get their chance.
  void write(const std::string& name,
             const std::function<void(const std::filesystem::path&)>& write);

  /// The same for text.
  void write_text(const std::string& name, const std::string& text);

  /// Notes a file that was written as the run went on, or why part of it is missing.
  void add(const std::string& path, const std::string& problem);

  std::string path_of(const std::string& name) const { return (path_ / name).string(); }
  const std::vector<std::string>& written() const { return written_; }
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  void place(const std::filesystem::path& part, const std::filesystem::path& whole) const;

  std::filesystem::path path_;
  bool force_;
  std::unique_ptr<tools::FolderLock> lock_;
  std::vector<std::string> written_;
  std::vector<std::string> failures_;
};

}  // namespace unisim::replay
