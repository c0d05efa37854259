// SPDX-License-Identifier: MIT
// One program at a time writes into a folder.
#pragma once

#include <string>

namespace unisim::tools {

/// Holds a folder until destruction. The system lets go of it when the process ends, however that
/// is; nothing is left in the folder. File systems without such locks (some network ones) are not
/// guarded.
class FolderLock {
 public:
  /// Throws Failure (2) when another process holds the folder.
  explicit FolderLock(const std::string& path);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace unisim::tools
