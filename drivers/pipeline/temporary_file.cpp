// SPDX-License-Identifier: MIT
// Bytes that grow with a run, kept on disk under no name.
#include "drivers/pipeline/temporary_file.hpp"

#include <fcntl.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkostemp is POSIX
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace unisim::pipeline {

TemporaryFile::TemporaryFile(const std::string& folder) {
  if (folder.empty()) return;
  std::string name = folder + "/.unisim-XXXXXX";
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ >= 0) ::unlink(name.c_str());
}

TemporaryFile::~TemporaryFile() {
  if (file_ >= 0) ::close(file_);
}

bool TemporaryFile::write_disk(int64_t offset, const char* bytes, size_t count) const {
  while (count > 0) {
    const ssize_t done = ::pwrite(file_, bytes, count, offset);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    count -= static_cast<size_t>(done);
    offset += done;
  }
  return true;
}

void TemporaryFile::write(int64_t offset, const void* bytes, size_t count) {
  const auto* from = static_cast<const char*>(bytes);
  const int64_t end = offset + static_cast<int64_t>(count);
  const bool may_grow = file_ >= 0 && rest_.empty();
  if ((end <= on_disk_ || may_grow) && write_disk(offset, from, count)) {
    on_disk_ = std::max(on_disk_, end);
    return;
  }
  if (offset < on_disk_) return;
  rest_.resize(std::max(rest_.size(), static_cast<size_t>(end - on_disk_)));
  std::memcpy(rest_.data() + (offset - on_disk_), from, count);
}

bool TemporaryFile::read(int64_t offset, void* bytes, size_t count) const {
  auto* to = static_cast<char*>(bytes);
  if (offset + static_cast<int64_t>(count) > size()) return false;
  while (count > 0 && offset < on_disk_) {
    const size_t here = std::min(count, static_cast<size_t>(on_disk_ - offset));
    const ssize_t done = ::pread(file_, to, here, offset);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    to += done;
    count -= static_cast<size_t>(done);
    offset += done;
  }
  if (count > 0) std::memcpy(to, rest_.data() + (offset - on_disk_), count);
  return true;
}

}  // namespace unisim::pipeline
