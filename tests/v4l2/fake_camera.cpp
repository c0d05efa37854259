// SPDX-License-Identifier: MIT
// The fake's files, mappings, clock and faults.
#include "tests/v4l2/fake_camera.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

namespace unisim::test {
namespace {

const char* name_of(unsigned long request) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return "VIDIOC_QUERYCAP";
    case VIDIOC_ENUM_FMT:
      return "VIDIOC_ENUM_FMT";
    case VIDIOC_ENUM_FRAMESIZES:
      return "VIDIOC_ENUM_FRAMESIZES";
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return "VIDIOC_ENUM_FRAMEINTERVALS";
    case VIDIOC_S_FMT:
      return "VIDIOC_S_FMT";
    case VIDIOC_S_PARM:
      return "VIDIOC_S_PARM";
    case VIDIOC_G_PARM:
      return "VIDIOC_G_PARM";
    case VIDIOC_QUERYCTRL:
      return "VIDIOC_QUERYCTRL";
    case VIDIOC_QUERYMENU:
      return "VIDIOC_QUERYMENU";
    case VIDIOC_G_CTRL:
      return "VIDIOC_G_CTRL";
    case VIDIOC_S_CTRL:
      return "VIDIOC_S_CTRL";
    case VIDIOC_REQBUFS:
      return "VIDIOC_REQBUFS";
    case VIDIOC_QUERYBUF:
      return "VIDIOC_QUERYBUF";
    case VIDIOC_QBUF:
      return "VIDIOC_QBUF";
    case VIDIOC_DQBUF:
      return "VIDIOC_DQBUF";
    case VIDIOC_STREAMON:
      return "VIDIOC_STREAMON";
    case VIDIOC_STREAMOFF:
      return "VIDIOC_STREAMOFF";
    default:
      return "unknown";
  }
}

}  // namespace

void FakeIo::plug(int number, std::shared_ptr<FakeCamera> camera) {
  nodes_[number] = std::move(camera);
}

void FakeIo::unplug(int number) {
  const auto node = nodes_.find(number);
  if (node == nodes_.end()) return;
  for (auto& [fd, file] : files_) {
    if (file.camera == node->second) file.gone = true;
  }
  nodes_.erase(node);
}

void FakeIo::fail(const std::string& call, int error, int nth, int times) {
  faults_[call] = {error, nth, times};
}

int FakeIo::calls(const std::string& call) const {
  const auto count = counts_.find(call);
  return count == counts_.end() ? 0 : count->second;
}

int FakeIo::fault(const std::string& call) {
  ++counts_[call];
  const auto found = faults_.find(call);
  if (found == faults_.end() || found->second.times == 0) return 0;
  if (found->second.skip-- > 0) return 0;
  --found->second.times;
  return -found->second.error;
}

void FakeIo::advance(int64_t to_ns) {
  while (true) {
    int64_t next_ns = to_ns;
    if (!events_.empty()) next_ns = std::min(next_ns, events_.begin()->first);
    for (const auto& [fd, file] : files_) {
      if (file.streaming && !file.gone) next_ns = std::min(next_ns, file.next_due_ns);
    }
    now_ns_ = std::max(now_ns_, next_ns);
    for (auto& [fd, file] : files_) {
      if (file.streaming && !file.gone && file.next_due_ns <= now_ns_) expose(&file);
    }
    if (!events_.empty() && events_.begin()->first <= now_ns_) {
      const std::function<void()> event = events_.begin()->second;
      events_.erase(events_.begin());
      event();
    } else if (next_ns >= to_ns) {
      return;
    }
  }
}

int FakeIo::open(const char* path) {
  if (const int error = fault("open")) return error;
  const std::string name = path;
  if (name.rfind("/dev/video", 0) != 0) return -ENOENT;
  const auto node = nodes_.find(std::atoi(name.c_str() + 10));
  if (node == nodes_.end()) return -ENOENT;
  files_[next_fd_].camera = node->second;
  return next_fd_++;
}

int FakeIo::close(int fd) {
  const int error = fault("close");
  const auto own = std::find(wake_fds_.begin(), wake_fds_.end(), fd);
  if (own != wake_fds_.end()) {
    wake_fds_.erase(own);
    --wakes_;
    ::close(fd);
    return error;
  }
  // A descriptor is closed whatever close() says.
  return files_.erase(fd) == 1 ? error : -EBADF;
}

int FakeIo::ioctl(int fd, unsigned long request, void* argument) {
  now_ns_ += 1000;
  const auto file = files_.find(fd);
  if (file == files_.end()) return -EBADF;
  if (const int error = fault(name_of(request))) return error;
  if (file->second.gone) return -ENODEV;
  return answer(&file->second, request, argument);
}

int FakeIo::map(int fd, size_t length, int64_t offset, void** address) {
  if (const int error = fault("mmap")) return error;
  const auto file = files_.find(fd);
  if (file == files_.end()) return -EBADF;
  const auto index = static_cast<size_t>(offset / 4096);
  if (index >= file->second.buffers.size()) return -EINVAL;
  const Bytes& bytes = file->second.buffers[index];
  if (bytes->size() != length) return -EINVAL;
  *address = bytes->data();
  mappings_[*address] = bytes;
  return 0;
}

int FakeIo::unmap(void* address, size_t) {
  const int error = fault("munmap");
  return mappings_.erase(address) == 1 ? error : -EINVAL;
}

int FakeIo::poll(pollfd* fds, unsigned count, int timeout_ms) {
  const int64_t deadline_ns = now_ns_ + int64_t{timeout_ms} * 1'000'000;
  if (const int error = fault("poll")) return error;
  while (true) {
    if (::poll(fds, 1, 0) > 0) return 1;
    File* file = count > 1 ? &files_.at(fds[1].fd) : nullptr;
    if (file != nullptr) {
      fds[1].revents = 0;
      if (file->gone) fds[1].revents = POLLERR | POLLHUP;
      if (file->camera->broken_stream) fds[1].revents = POLLERR;
      if (!file->done.empty()) fds[1].revents = static_cast<short>(fds[1].revents | POLLIN);
      if (fds[1].revents != 0) return 1;
    }
    if (waits_for_real_) {
      ::poll(fds, 1, -1);
      continue;
    }
    if (now_ns_ >= deadline_ns) return 0;
    int64_t next_ns = deadline_ns;
    if (file != nullptr) next_ns = std::min(next_ns, file->next_due_ns);
    if (!events_.empty()) next_ns = std::min(next_ns, events_.begin()->first);
    advance(std::max(next_ns, now_ns_ + 1));
  }
}

int FakeIo::make_wake() {
  if (const int error = fault("eventfd")) return error;
  wake_fds_.push_back(::eventfd(0, EFD_NONBLOCK));
  ++wakes_;
  return wake_fds_.back();
}

int FakeIo::wake(int fd) { return ::eventfd_write(fd, 1); }

int FakeIo::list_numbers(std::vector<int>* numbers) {
  if (const int error = fault("opendir")) return error;
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) numbers->push_back(node->first);
  return 0;
}

std::string FakeIo::resolve(const std::string& path) {
  return path == "/dev/camera" ? "/dev/video0" : path;
}

}  // namespace unisim::test
