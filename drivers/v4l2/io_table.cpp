// SPDX-License-Identifier: MIT
// The system's own calls behind the table.
#include "drivers/v4l2/io_table.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>

namespace unisim::v4l2 {
namespace {

int result(int answer) { return answer >= 0 ? answer : -errno; }

int64_t clock_ns(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<int64_t>(time.tv_sec) * 1000000000 + time.tv_nsec;
}

class SystemIo final : public Io {
 public:
  int open(const char* path) override {
    return result(::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC));
  }
  int close(int fd) override { return result(::close(fd)); }
  int ioctl(int fd, unsigned long request, void* argument) override {
    return result(::ioctl(fd, request, argument));
  }
  int map(int fd, size_t length, int64_t offset, void** address) override {
    *address =
        ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
    return *address == MAP_FAILED ? -errno : 0;
  }
  int unmap(void* address, size_t length) override { return result(::munmap(address, length)); }
  int poll(pollfd* fds, unsigned count, int timeout_ms) override {
    return result(::poll(fds, count, timeout_ms));
  }
  int64_t monotonic_ns() override { return clock_ns(CLOCK_MONOTONIC); }
  int64_t realtime_ns() override { return clock_ns(CLOCK_REALTIME); }
  int make_wake() override { return result(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)); }
  int wake(int fd) override { return result(::eventfd_write(fd, 1)); }
  int list_numbers(std::vector<int>* numbers) override;
  std::string resolve(const std::string& path) override;
};

int SystemIo::list_numbers(std::vector<int>* numbers) {
  DIR* folder = ::opendir("/dev");
  if (folder == nullptr) return -errno;
  while (const dirent* entry = ::readdir(folder)) {
    const std::string name = entry->d_name;
    // The kernel has 256 of them at most; longer names are someone else's.
    if (name.rfind("video", 0) != 0 || name.size() < 6 || name.size() > 9) continue;
    if (name.find_first_not_of("0123456789", 5) != std::string::npos) continue;
    numbers->push_back(std::atoi(name.c_str() + 5));
  }
  ::closedir(folder);
  return 0;
}

std::string SystemIo::resolve(const std::string& path) {
  char* found = ::realpath(path.c_str(), nullptr);
  if (found == nullptr) return path;
  std::string answer = found;
  std::free(found);
  return answer;
}

}  // namespace

Io& system_io() {
  static SystemIo io;
  return io;
}

int ioctl_again(Io& io, int fd, unsigned long request, void* argument) {
  int answer = 0;
  do {
    answer = io.ioctl(fd, request, argument);
  } while (answer == -EINTR);
  return answer;
}

int open_again(Io& io, const char* path) {
  int answer = 0;
  do {
    answer = io.open(path);
  } while (answer == -EINTR);
  return answer;
}

}  // namespace unisim::v4l2
