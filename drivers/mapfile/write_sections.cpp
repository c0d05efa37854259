// SPDX-License-Identifier: MIT
// Writes a file of named parts beside its place, and puts it there when the disk has it.
#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "drivers/mapfile/format.hpp"
#include "drivers/mapfile/sections.hpp"
#include "drivers/recorded/crc32c.hpp"

namespace unisim::mapfile {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPartEnding = ".part";

[[noreturn]] void fail(const std::string& path, int problem) {
  throw Error(Error::Kind::kDevice,
              path + ": the map cannot be written (" + std::strerror(problem) + ")");
}

void put(uint64_t value, size_t bytes, Bytes* out) {
  for (size_t k = 0; k < bytes; ++k) out->push_back(static_cast<uint8_t>(value >> (8 * k)));
}

Bytes head_of(const std::vector<Section>& sections) {
  Bytes head(kMagic, kMagic + sizeof kMagic);
  put(kVersion, 4, &head);
  put(sections.size(), 4, &head);
  for (const Section& section : sections) {
    std::string name = section.name;
    name.resize(kNameBytes, '\0');
    head.insert(head.end(), name.begin(), name.end());
    put(section.bytes.size(), 8, &head);
    put(recorded::crc32c(section.bytes.data(), section.bytes.size()), 4, &head);
  }
  put(recorded::crc32c(head.data(), head.size()), 4, &head);
  return head;
}

/// A file that is new or goes.
class PartFile {
 public:
  explicit PartFile(const fs::path& whole)
      : whole_(whole),
        part_(whole.parent_path() / (stem(whole) + std::to_string(getpid()) + kPartEnding)) {
    remove_left_over();
    ::unlink(part_.c_str());
    file_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (file_ < 0) fail(whole_.string(), errno);
    // Held while it is written: of a file without it the writer has died.
    ::flock(file_, LOCK_EX | LOCK_NB);
  }
  ~PartFile() {
    if (file_ < 0) return;
    ::close(file_);
    ::unlink(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void write(const Bytes& bytes) const {
    size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::write(file_, bytes.data() + done, bytes.size() - done);
      if (count > 0)
        done += static_cast<size_t>(count);
      else if (count < 0 && errno != EINTR)
        fail(whole_.string(), errno);
    }
  }

  /// On the disk, then in its place, then that too on the disk.
  void place() {
    if (::fsync(file_) != 0 && errno != EINVAL) fail(whole_.string(), errno);
    if (::rename(part_.c_str(), whole_.c_str()) != 0) fail(whole_.string(), errno);
    ::close(file_);
    file_ = -1;
    const int folder = ::open(whole_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    // Not every file system can: the file is whole either way.
    static_cast<void>(::fsync(folder));
    ::close(folder);
  }

 private:
  static std::string stem(const fs::path& whole) { return "." + whole.filename().string() + "."; }

  /// Of writers that were killed.
  void remove_left_over() const {
    std::error_code ignored;
    const std::string begin = stem(whole_);
    for (fs::directory_iterator entry(whole_.parent_path(), ignored), end; entry != end;
         entry.increment(ignored)) {
      const std::string name = entry->path().filename().string();
      const bool part = name.rfind(begin, 0) == 0 && entry->path().extension() == kPartEnding;
      if (!part) continue;
      const int file = ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
      if (file < 0) continue;
      if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
      ::close(file);
    }
  }

  fs::path whole_;
  fs::path part_;
  int file_ = -1;
};

/// What the name stands for: a link keeps pointing to the map.
fs::path place_of(const std::string& path) {
  std::error_code problem;
  fs::path whole = fs::weakly_canonical(fs::absolute(path), problem);
  if (problem) fail(path, problem.value());
  const fs::file_status status = fs::status(whole, problem);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(Error::Kind::kInput, path + ": is no file that a map could be written to");
  }
  if (!whole.has_filename()) {
    throw Error(Error::Kind::kInput, path + ": is a folder; name a file for the map");
  }
  return whole;
}

}  // namespace

void write_sections(const std::string& path, const std::vector<Section>& sections) {
  PartFile file(place_of(path));
  file.write(head_of(sections));
  for (const Section& section : sections) file.write(section.bytes);
  file.place();
}

void check_writable(const std::string& path) { const PartFile probe(place_of(path)); }

}  // namespace unisim::mapfile
