// SPDX-License-Identifier: MIT
// The ring of mapped buffers that the kernel fills.
#include "drivers/v4l2/buffers.hpp"

#include <cerrno>

#include "drivers/v4l2/failure.hpp"
#include "drivers/v4l2/v4l2.h"

namespace unisim::v4l2 {
namespace {

// One in the caller's hands, one being filled: with fewer the camera stands still.
constexpr uint32_t kLeast = 2;

v4l2_buffer blank(uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

Buffers::Buffers(Io& io, int fd, const std::string& device, int count) : io_(io), fd_(fd) {
  try {
    request(device, count);
    map(device);
    start(device);
  } catch (...) {
    release();
    throw;
  }
}

Buffers::~Buffers() { release(); }

void Buffers::request(const std::string& device, int count) {
  v4l2_requestbuffers request{};
  request.count = static_cast<uint32_t>(count);
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  const int status = ioctl_again(io_, fd_, VIDIOC_REQBUFS, &request);
  if (status < 0) throw call_failed(device, "VIDIOC_REQBUFS", -status);
  granted_ = request.count;
  if (granted_ < kLeast) {
    throw DeviceError(UNISIM_V4L2_FAILED, 0,
                      device + ": has memory for " + std::to_string(granted_) +
                          " frames: ask for a smaller size");
  }
}

void Buffers::map(const std::string& device) {
  maps_.reserve(granted_);
  for (uint32_t i = 0; i < granted_; ++i) {
    v4l2_buffer buffer = blank(i);
    int status = ioctl_again(io_, fd_, VIDIOC_QUERYBUF, &buffer);
    if (status < 0) throw call_failed(device, "VIDIOC_QUERYBUF", -status);
    Map one{nullptr, buffer.length};
    status = io_.map(fd_, buffer.length, buffer.m.offset, &one.address);
    if (status < 0) throw call_failed(device, "mmap", -status);
    maps_.push_back(one);
  }
}

void Buffers::start(const std::string& device) {
  for (uint32_t i = 0; i < granted_; ++i) {
    const int status = queue(i);
    if (status < 0) throw call_failed(device, "VIDIOC_QBUF", -status);
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  const int status = ioctl_again(io_, fd_, VIDIOC_STREAMON, &type);
  if (status < 0) throw call_failed(device, "VIDIOC_STREAMON", -status);
  streaming_ = true;
}

// All of it is tried, whatever fails on the way: of a camera that is gone nothing else is left.
void Buffers::release() {
  if (streaming_) {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    ioctl_again(io_, fd_, VIDIOC_STREAMOFF, &type);
  }
  for (const Map& one : maps_) io_.unmap(one.address, one.length);
  maps_.clear();
  if (granted_ > 0) {
    v4l2_requestbuffers none{};
    none.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    none.memory = V4L2_MEMORY_MMAP;
    ioctl_again(io_, fd_, VIDIOC_REQBUFS, &none);
  }
}

int Buffers::dequeue(v4l2_buffer* buffer) {
  *buffer = blank(0);
  const int status = ioctl_again(io_, fd_, VIDIOC_DQBUF, buffer);
  if (status < 0) return status;
  if (buffer->index >= count()) return -EIO;
  --queued_;
  return 0;
}

int Buffers::queue(uint32_t index) {
  v4l2_buffer buffer = blank(index);
  const int status = ioctl_again(io_, fd_, VIDIOC_QBUF, &buffer);
  if (status == 0) ++queued_;
  return status < 0 ? status : 0;
}

}  // namespace unisim::v4l2
