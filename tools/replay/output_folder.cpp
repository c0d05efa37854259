// SPDX-License-Identifier: MIT
// The folder of results.
#include "tools/replay/output_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "tools/common/failure.hpp"

namespace unisim::replay {
namespace fs = std::filesystem;
namespace {

// Below this the small result files of a short run do not fit either.
constexpr std::uintmax_t kLeastSpace = 1 << 20;

tools::Failure unwritable(const fs::path& path, const std::string& why) {
  return {tools::kExitInput,
          path.string() + ": cannot be written (" + why + "); choose another --out"};
}

void make_folder(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error)) {
    throw tools::Failure(tools::kExitInput,
                         path.string() + ": is not a folder; choose another --out");
  }
  fs::create_directories(path, error);
  if (error) throw unwritable(path, error.message());
}

void try_writing(const fs::path& path) {
  const fs::path probe = path / ".unisim-probe";
  const int file = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) throw unwritable(path, std::strerror(errno));
  ::close(file);
  ::unlink(probe.c_str());
  std::error_code error;
  const fs::space_info space = fs::space(path, error);
  if (!error && space.available < kLeastSpace) {
    throw tools::Failure(tools::kExitLimit,
                         path.string() +
                             ": no space left on the device; make room or choose "
                             "another --out");
  }
}

void write_all(const fs::path& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) throw std::system_error(errno, std::generic_category());
  size_t done = 0;
  int problem = 0;
  while (done < text.size() && problem == 0) {
    const ssize_t count = ::write(file, text.data() + done, text.size() - done);
    if (count > 0)
      done += static_cast<size_t>(count);
    else if (errno != EINTR)
      problem = errno;
  }
  if (problem == 0 && ::fsync(file) != 0 && errno != EINVAL) problem = errno;
  if (::close(file) != 0 && problem == 0) problem = errno;
  if (problem != 0) throw std::system_error(problem, std::generic_category());
}

constexpr const char* kPartEnding = ".part";

std::string part_stem(const std::string& name) { return "." + name + "."; }

bool begins_and_ends(const std::string& text, const std::string& begin, const std::string& end) {
  return text.size() >= begin.size() + end.size() && text.rfind(begin, 0) == 0 &&
         text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// What a run that was killed has left; nobody else writes here now.
void remove_parts(const fs::path& path, const std::vector<std::string>& names) {
  std::error_code ignored;
  for (fs::directory_iterator file(path, ignored), end; file != end; file.increment(ignored)) {
    const std::string found = file->path().filename().string();
    const auto left_over = [&](const std::string& name) {
      return begins_and_ends(found, part_stem(name), kPartEnding);
    };
    if (std::any_of(names.begin(), names.end(), left_over)) fs::remove(file->path(), ignored);
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const std::vector<std::string>& names,
                           bool force)
    : path_(path), force_(force) {
  make_folder(path_);
  lock_ = std::make_unique<tools::FolderLock>(path);
  remove_parts(path_, names);
  for (const std::string& name : names) {
    std::error_code error;
    if (!force && fs::exists(path_ / name, error)) {
      throw tools::Failure(tools::kExitUsage,
                           path_of(name) + ": exists; give --force to overwrite, or another --out");
    }
  }
  try_writing(path_);
}

void OutputFolder::write(const std::string& name,
                         const std::function<void(const fs::path&)>& write) {
  const fs::path whole = path_ / name;
  const fs::path part = path_ / (part_stem(name) + std::to_string(getpid()) + kPartEnding);
  std::error_code ignored;
  try {
    write(part);
    place(part, whole);
    written_.push_back(whole.string());
  } catch (const std::system_error& error) {
    failures_.push_back(whole.string() + ": " + error.code().message());
    fs::remove(part, ignored);
  } catch (const std::exception& error) {
    failures_.push_back(whole.string() + ": " + error.what());
    fs::remove(part, ignored);
  }
}

void OutputFolder::add(const std::string& path, const std::string& problem) {
  if (problem.empty())
    written_.push_back(path);
  else
    failures_.push_back(path + ": " + problem);
}

void OutputFolder::place(const fs::path& part, const fs::path& whole) const {
  const unsigned flags = force_ ? 0 : RENAME_NOREPLACE;
  if (::renameat2(AT_FDCWD, part.c_str(), AT_FDCWD, whole.c_str(), flags) == 0) return;
  // Not every file system can do that in one step.
  if (errno != EINVAL && errno != ENOSYS) throw std::system_error(errno, std::generic_category());
  if (!force_ && fs::exists(whole)) throw std::system_error(EEXIST, std::generic_category());
  fs::rename(part, whole);
}

void OutputFolder::write_text(const std::string& name, const std::string& text) {
  write(name, [&](const fs::path& path) { write_all(path, text); });
}

}  // namespace unisim::replay
