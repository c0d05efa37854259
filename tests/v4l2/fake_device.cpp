// SPDX-License-Identifier: MIT
// What the fake's cameras answer, and the frames they make.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "tests/v4l2/fake_camera.hpp"

namespace unisim::test {
namespace {

template <size_t kSize>
void copy_text(uint8_t (&to)[kSize], const std::string& from) {
  std::snprintf(reinterpret_cast<char*>(to), kSize, "%s", from.c_str());
}

const FakeFormat* format_of(const FakeCamera& camera, uint32_t fourcc) {
  for (const FakeFormat& format : camera.formats) {
    if (format.fourcc == fourcc) return &format;
  }
  return nullptr;
}

v4l2_fract interval_of(double rate) {
  return {1000, static_cast<uint32_t>(std::lround(rate * 1000))};
}

int32_t whole_steps(int32_t wish, int32_t low, int32_t high, int32_t step) {
  return low + (std::clamp(wish, low, high) - low) / step * step;
}

// Frame intervals are asked for at one size.
const FakeSize* size_of(const FakeCamera& camera, uint32_t fourcc, int32_t width, int32_t height) {
  const FakeFormat* format = format_of(camera, fourcc);
  if (format == nullptr) return nullptr;
  if (format->step > 0) return &format->sizes.front();
  for (const FakeSize& size : format->sizes) {
    if (size.width == width && size.height == height) return &size;
  }
  return nullptr;
}

}  // namespace

int FakeIo::answer(File* file, unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return query_capabilities(*file, static_cast<v4l2_capability*>(argument));
    case VIDIOC_ENUM_FMT:
      return list_format(*file, static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_ENUM_FRAMESIZES:
      return list_size(*file, static_cast<v4l2_frmsizeenum*>(argument));
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return list_rate(*file, static_cast<v4l2_frmivalenum*>(argument));
    case VIDIOC_S_FMT:
      return set_format(file, static_cast<v4l2_format*>(argument));
    case VIDIOC_S_PARM:
      return set_rate(file, static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_G_PARM:
      return get_rate(*file, static_cast<v4l2_streamparm*>(argument));
    case VIDIOC_QUERYCTRL:
      return query_control(*file, static_cast<v4l2_queryctrl*>(argument));
    case VIDIOC_QUERYMENU:
      return query_menu(*file, *static_cast<v4l2_querymenu*>(argument));
    case VIDIOC_G_CTRL:
      return get_control(*file, static_cast<v4l2_control*>(argument));
    case VIDIOC_S_CTRL:
      return set_control(file, *static_cast<v4l2_control*>(argument));
    case VIDIOC_REQBUFS:
      return request_buffers(file, static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF:
      return query_buffer(*file, static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      return queue(file, *static_cast<v4l2_buffer*>(argument));
    case VIDIOC_DQBUF:
      return dequeue(file, static_cast<v4l2_buffer*>(argument));
    case VIDIOC_STREAMON:
      return start(file);
    case VIDIOC_STREAMOFF:
      return stop(file);
    default:
      return -ENOTTY;
  }
}

int FakeIo::query_capabilities(const File& file, v4l2_capability* answer) {
  copy_text(answer->driver, file.camera->driver);
  copy_text(answer->card, file.camera->card);
  copy_text(answer->bus_info, file.camera->bus);
  answer->device_caps = file.camera->capabilities;
  // Of all nodes of a device together: more than this one can do.
  answer->capabilities =
      V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING | V4L2_CAP_META_CAPTURE;
  return 0;
}

int FakeIo::list_format(const File& file, v4l2_fmtdesc* entry) {
  if (entry->index >= file.camera->formats.size()) return -EINVAL;
  entry->pixelformat = file.camera->formats[entry->index].fourcc;
  return 0;
}

int FakeIo::list_size(const File& file, v4l2_frmsizeenum* entry) {
  const FakeFormat* format = format_of(*file.camera, entry->pixel_format);
  if (!file.camera->lists_sizes || format == nullptr || entry->index >= format->sizes.size()) {
    return -EINVAL;
  }
  const FakeSize& size = format->sizes[entry->index];
  if (format->step > 0) {
    if (entry->index > 0) return -EINVAL;
    const FakeSize& last = format->sizes.back();
    const auto step = static_cast<uint32_t>(format->step);
    entry->type = V4L2_FRMSIZE_TYPE_STEPWISE;
    entry->stepwise = {
        static_cast<uint32_t>(size.width),  static_cast<uint32_t>(last.width),  step,
        static_cast<uint32_t>(size.height), static_cast<uint32_t>(last.height), step};
    return 0;
  }
  entry->type = V4L2_FRMSIZE_TYPE_DISCRETE;
  entry->discrete = {static_cast<uint32_t>(size.width), static_cast<uint32_t>(size.height)};
  return 0;
}

int FakeIo::list_rate(const File& file, v4l2_frmivalenum* entry) {
  const FakeSize* size =
      size_of(*file.camera, entry->pixel_format, static_cast<int32_t>(entry->width),
              static_cast<int32_t>(entry->height));
  if (size == nullptr || entry->index >= size->rates.size()) return -EINVAL;
  if (format_of(*file.camera, entry->pixel_format)->step > 0) {
    entry->type = V4L2_FRMIVAL_TYPE_CONTINUOUS;
    entry->stepwise.min = interval_of(size->rates.back());
    entry->stepwise.max = interval_of(size->rates.front());
    return entry->index == 0 ? 0 : -EINVAL;
  }
  entry->type = V4L2_FRMIVAL_TYPE_DISCRETE;
  entry->discrete = interval_of(size->rates[entry->index]);
  return 0;
}

// As drivers do: what is not there becomes something that is.
int FakeIo::set_format(File* file, v4l2_format* format) {
  v4l2_pix_format& pixels = format->fmt.pix;
  const FakeCamera& camera = *file->camera;
  const FakeFormat* known = format_of(camera, pixels.pixelformat);
  if (known == nullptr) known = &camera.formats.front();
  if (!file->buffers.empty()) return -EBUSY;
  const FakeSize* nearest = &known->sizes.front();
  const auto error = [&pixels](const FakeSize& size) {
    return std::abs(size.width - static_cast<int32_t>(pixels.width)) +
           std::abs(size.height - static_cast<int32_t>(pixels.height));
  };
  for (const FakeSize& size : known->sizes) {
    if (error(size) < error(*nearest)) nearest = &size;
  }
  FakeSize chosen = *nearest;
  if (known->step > 0) {
    const FakeSize& low = known->sizes.front();
    const FakeSize& high = known->sizes.back();
    chosen.width =
        whole_steps(static_cast<int32_t>(pixels.width), low.width, high.width, known->step);
    chosen.height =
        whole_steps(static_cast<int32_t>(pixels.height), low.height, high.height, known->step);
  }
  const int32_t width = camera.forced_width > 0 ? camera.forced_width : chosen.width;
  const int32_t height = camera.forced_height > 0 ? camera.forced_height : chosen.height;
  pixels.pixelformat = known->fourcc;
  pixels.width = static_cast<uint32_t>(width);
  pixels.height = static_cast<uint32_t>(height);
  pixels.field = V4L2_FIELD_NONE;
  const int32_t row = known->fourcc == V4L2_PIX_FMT_YUYV ? 2 * width : width;
  const bool jpeg = known->fourcc == V4L2_PIX_FMT_MJPEG;
  pixels.bytesperline = jpeg ? 0 : static_cast<uint32_t>(row + camera.row_padding);
  pixels.sizeimage = static_cast<uint32_t>((row + camera.row_padding) * height * 2);
  file->pixels = pixels;
  return 0;
}

int FakeIo::set_rate(File* file, v4l2_streamparm* parameters) {
  const v4l2_fract wish = parameters->parm.capture.timeperframe;
  const double rate = double(wish.denominator) / wish.numerator;
  const FakeSize* size =
      size_of(*file->camera, file->pixels.pixelformat, static_cast<int32_t>(file->pixels.width),
              static_cast<int32_t>(file->pixels.height));
  file->fps = rate;
  if (size != nullptr && !size->rates.empty()) {
    file->fps = *std::min_element(size->rates.begin(), size->rates.end(), [&](double a, double b) {
      return std::abs(a - rate) < std::abs(b - rate);
    });
  }
  return get_rate(*file, parameters);
}

int FakeIo::get_rate(const File& file, v4l2_streamparm* parameters) {
  parameters->parm.capture.timeperframe = interval_of(file.fps);
  return 0;
}

int FakeIo::query_control(const File& file, v4l2_queryctrl* range) {
  const auto control = file.camera->controls.find(range->id);
  if (control == file.camera->controls.end()) return -EINVAL;
  range->minimum = control->second.minimum;
  range->maximum = control->second.maximum;
  return 0;
}

int FakeIo::query_menu(const File& file, const v4l2_querymenu& entry) {
  const auto control = file.camera->controls.find(entry.id);
  if (control == file.camera->controls.end()) return -EINVAL;
  const std::vector<int32_t>& choices = control->second.choices;
  const auto index = static_cast<int32_t>(entry.index);
  return std::find(choices.begin(), choices.end(), index) != choices.end() ? 0 : -EINVAL;
}

int FakeIo::get_control(const File& file, v4l2_control* control) {
  const auto found = file.camera->controls.find(control->id);
  if (found == file.camera->controls.end()) return -EINVAL;
  control->value = found->second.value;
  return 0;
}

int FakeIo::set_control(File* file, const v4l2_control& control) {
  const auto found = file->camera->controls.find(control.id);
  if (found == file->camera->controls.end()) return -EINVAL;
  found->second.value = control.value;
  return 0;
}

int FakeIo::request_buffers(File* file, v4l2_requestbuffers* request) {
  request->count = std::min(request->count, file->camera->most_buffers);
  file->buffers.clear();
  file->queued.clear();
  file->done.clear();
  for (uint32_t i = 0; i < request->count; ++i) {
    file->buffers.push_back(std::make_shared<std::vector<uint8_t>>(file->pixels.sizeimage));
  }
  return 0;
}

int FakeIo::query_buffer(const File& file, v4l2_buffer* buffer) {
  if (buffer->index >= file.buffers.size()) return -EINVAL;
  buffer->length = static_cast<uint32_t>(file.buffers[buffer->index]->size());
  buffer->m.offset = buffer->index * 4096;
  return 0;
}

int FakeIo::queue(File* file, const v4l2_buffer& buffer) {
  const auto is_in = [&](const auto& list, auto same) {
    return std::find_if(list.begin(), list.end(), same) != list.end();
  };
  if (buffer.index >= file->buffers.size() ||
      is_in(file->queued, [&](uint32_t i) { return i == buffer.index; }) ||
      is_in(file->done, [&](const v4l2_buffer& one) { return one.index == buffer.index; })) {
    return -EINVAL;
  }
  file->queued.push_back(buffer.index);
  return 0;
}

int FakeIo::dequeue(File* file, v4l2_buffer* buffer) {
  if (!file->streaming) return -EINVAL;
  if (file->camera->broken_stream) return -EIO;
  if (file->done.empty()) return -EAGAIN;
  *buffer = file->done.front();
  file->done.pop_front();
  return 0;
}

int FakeIo::start(File* file) const {
  file->streaming = true;
  file->next_due_ns = file->camera->silent ? INT64_MAX : now_ns_ + std::lround(1e9 / file->fps);
  return 0;
}

int FakeIo::stop(File* file) {
  file->streaming = false;
  file->camera->broken_stream = false;
  file->queued.clear();
  file->done.clear();
  return 0;
}

FakeFrame FakeIo::make_frame(const File& file) const {
  const v4l2_pix_format& pixels = file.pixels;
  FakeFrame frame{
      file.camera->next_sequence++, now_ns_, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, {}, false};
  const int pixel = pixels.pixelformat == V4L2_PIX_FMT_YUYV ? 2 : 1;
  frame.bytes.assign(size_t{pixels.bytesperline} * pixels.height, 7);
  for (uint32_t y = 0; y < pixels.height && pixels.bytesperline > 0; ++y) {
    for (uint32_t x = 0; x < pixels.width; ++x) {
      frame.bytes[size_t{y} * pixels.bytesperline + size_t{x} * static_cast<size_t>(pixel)] =
          fake_gray(static_cast<int32_t>(x), static_cast<int32_t>(y), frame.sequence);
    }
  }
  return frame;
}

void FakeIo::expose(File* file) {
  file->next_due_ns += std::lround(1e9 / file->fps);
  FakeFrame frame = make_frame(*file);
  if (file->camera->script) file->camera->script(&frame);
  if (frame.never_comes || file->queued.empty()) return;
  v4l2_buffer buffer{};
  buffer.index = file->queued.front();
  file->queued.pop_front();
  std::vector<uint8_t>& memory = *file->buffers[buffer.index];
  std::copy_n(frame.bytes.begin(), std::min(frame.bytes.size(), memory.size()), memory.begin());
  buffer.bytesused = static_cast<uint32_t>(frame.bytes.size());
  buffer.flags = frame.flags;
  buffer.sequence = frame.sequence;
  buffer.timestamp.tv_sec = frame.stamp_ns / 1'000'000'000;
  buffer.timestamp.tv_usec = frame.stamp_ns % 1'000'000'000 / 1000;
  file->done.push_back(buffer);
}

}  // namespace unisim::test
