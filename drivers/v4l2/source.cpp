// SPDX-License-Identifier: MIT
// A camera as a source of frames: waiting, losing it, finding it again.
#include "drivers/v4l2/source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>

#include "drivers/common/size_text.hpp"
#include "drivers/v4l2/failure.hpp"

namespace unisim::v4l2 {
namespace {

constexpr int64_t kMillisecond = 1'000'000;
// A camera that is plugged in takes a second or two to be there: this adds little to that.
constexpr int64_t kLookEvery = 200 * kMillisecond;
// A stream that breaks more often without a frame in between will not get better. A plug that is
// being pushed in makes and breaks contact a few times.
constexpr int kMostBreaks = 3;
constexpr int kMostUnplugged = 10;
// One second of damage at the usual rate: then the stream is started anew.
constexpr int kMostDamaged = 30;

CameraSource* self(unisim_source* source) { return static_cast<CameraSource*>(source); }

template <size_t kSize>
void copy_text(char (&to)[kSize], const std::string& from) {
  std::snprintf(to, kSize, "%s", from.c_str());
}

}  // namespace

CameraSource::CameraSource(Io& io, const Settings& settings)
    : unisim_source{},
      io_(io),
      settings_(settings),
      wake_(io, io.make_wake()),
      capture_(io, &counters_) {
  if (wake_.fd() < 0) throw call_failed("camera", "eventfd", -wake_.fd());
  const std::string path = find_device(io_, settings_.device);
  device_ = std::make_unique<Device>(io_, path, settings_, &controls_, &notes_);
  anchor_ = make_anchor(io_, path, device_->identity());
  capture_.use(device_.get());
  fill_mode();
  // The same again when it comes back: a camera of many formats might change its mind.
  settings_.fourcc = device_->mode().fourcc;
  fill_table();
}

CameraSource::~CameraSource() = default;

void CameraSource::fill_table() {
  struct_size = sizeof(unisim_source);
  format = "v4l2";
  frame_count = [](unisim_source*) -> int64_t { return -1; };
  next_frame = [](unisim_source* source, int decode, unisim_frame* frame) {
    *frame = {};
    return self(source)->read(decode != 0, frame);
  };
  interrupt = [](unisim_source* source) { self(source)->stop(); };
  ground_truth = [](unisim_source*, const unisim_stamped_pose** poses) -> int64_t {
    *poses = nullptr;
    return 0;
  };
  ground_truth_path = [](unisim_source*) { return ""; };
  message = [](unisim_source* source) -> const char* { return self(source)->message_; };
  destroy = [](unisim_source* source) {
    if (source != nullptr) delete self(source);
  };
}

void CameraSource::fill_mode() {
  const Mode& mode = device_->mode();
  mode_.struct_size = sizeof mode_;
  mode_.width = mode.width;
  mode_.height = mode.height;
  mode_.fps = mode.fps;
  copy_text(mode_.pixel_format, fourcc_text(mode.fourcc));
  copy_text(mode_.device, device_->path());
  copy_text(mode_.card, device_->identity().card);
  copy_text(mode_.bus, device_->identity().bus);
}

void CameraSource::stop() {
  interrupted_ = true;
  io_.wake(wake_.fd());
}

int CameraSource::read(bool decode, unisim_frame* frame) {
  if (failed_) return UNISIM_FRAME_FAILED;
  try {
    return device_ != nullptr ? read_frame(decode, frame) : come_back();
  } catch (const std::exception& error) {
    return give_up(error.what());
  }
}

int CameraSource::read_frame(bool decode, unisim_frame* frame) {
  if (!capture_.release()) return lose(capture_.failed_call(), capture_.error());
  const int64_t deadline_ns = io_.monotonic_ns() + settings_.config.frame_timeout_ms * kMillisecond;
  while (true) {
    const Wake wake = wait(device_->fd(), deadline_ns);
    if (wake == Wake::kInterrupted) return UNISIM_FRAME_END;
    if (wake == Wake::kTimeout) return lose("no frame came", ETIMEDOUT);
    if (wake == Wake::kFailed) return lose("poll", poll_error_);
    bool again = false;
    const int status = take_frame(decode, wake == Wake::kTrouble, frame, &again);
    if (!again) return status;
    // Ready time and again but with nothing in it.
    if (io_.monotonic_ns() >= deadline_ns) return lose("no frame came", ETIMEDOUT);
  }
}

int CameraSource::take_frame(bool decode, bool trouble, unisim_frame* frame, bool* again) {
  switch (capture_.take(decode, frame)) {
    case Capture::Result::kFrame:
      lost_since_ns_ = 0;
      losses_ = 0;
      damaged_ = 0;
      return UNISIM_FRAME_OK;
    case Capture::Result::kBad:
      if (++damaged_ >= kMostDamaged) return lose("nothing but damaged frames", EIO);
      std::snprintf(message_, sizeof message_, "%s", capture_.message());
      return UNISIM_FRAME_BAD;
    case Capture::Result::kFailed:
      return lose(capture_.failed_call(), capture_.error());
    case Capture::Result::kNothing:
      break;
  }
  // An error that the next call would not tell would be waited on without end.
  if (trouble) return lose("poll", EIO);
  *again = true;
  return UNISIM_FRAME_OK;
}

/// @param fd < 0: only for an interrupt
CameraSource::Wake CameraSource::wait(int fd, int64_t deadline_ns) {
  while (!interrupted_) {
    const int64_t left_ns = std::max<int64_t>(0, deadline_ns - io_.monotonic_ns());
    pollfd fds[2] = {{wake_.fd(), POLLIN, 0}, {fd, POLLIN, 0}};
    const int status = io_.poll(fds, fd >= 0 ? 2 : 1,
                                static_cast<int>((left_ns + kMillisecond - 1) / kMillisecond));
    if (status < 0 && status != -EINTR) {
      poll_error_ = -status;
      return Wake::kFailed;
    }
    if (interrupted_ || (status > 0 && fds[0].revents != 0)) break;
    if (status > 0 && (fds[1].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return Wake::kTrouble;
    if (status > 0 && fds[1].revents != 0) return Wake::kReady;
    if (left_ns == 0) return Wake::kTimeout;
  }
  return Wake::kInterrupted;
}

int CameraSource::give_up(const char* text) {
  failed_ = true;
  capture_.use(nullptr);
  device_.reset();
  std::snprintf(message_, sizeof message_, "%s", text);
  return UNISIM_FRAME_FAILED;
}

int CameraSource::lose(const char* call, int error) {
  char text[512];
  describe(device_->path().c_str(), call, error, text, sizeof text);
  unplugged_ = means_unplugged(error);
  if (lost_since_ns_ == 0) lost_since_ns_ = io_.monotonic_ns();
  ++losses_;
  if (losses_ > (unplugged_ ? kMostUnplugged : kMostBreaks) ||
      (unplugged_ && settings_.config.reconnect_ms == 0)) {
    return give_up(text);
  }
  if (unplugged_) {
    std::snprintf(message_, sizeof message_, "%s: unplugged: waiting %.4g s for it to come back",
                  device_->path().c_str(), settings_.config.reconnect_ms / 1000.0);
  } else {
    std::snprintf(message_, sizeof message_, "%s; starting it anew", text);
  }
  damaged_ = 0;
  capture_.use(nullptr);
  device_.reset();
  return UNISIM_FRAME_BAD;
}

int CameraSource::come_back() {
  const int64_t deadline_ns = lost_since_ns_ + settings_.config.reconnect_ms * kMillisecond;
  std::string reason;
  while (!open_again(&reason)) {
    if (failed_) return UNISIM_FRAME_FAILED;
    const int64_t now_ns = io_.monotonic_ns();
    if (now_ns >= deadline_ns) return give_up(reason.c_str());
    const Wake wake = wait(-1, std::min(deadline_ns, now_ns + kLookEvery));
    if (wake == Wake::kInterrupted) return UNISIM_FRAME_END;
    if (wake == Wake::kFailed)
      return give_up(call_failed(anchor_.path, "poll", poll_error_).what());
  }
  ++(unplugged_ ? counters_.reconnects : counters_.restarts);
  std::snprintf(message_, sizeof message_, "%s: %s after %.1f s", device_->path().c_str(),
                unplugged_ ? "the camera is back" : "started anew",
                static_cast<double>(io_.monotonic_ns() - lost_since_ns_) / 1e9);
  return UNISIM_FRAME_BAD;
}

/// @param[out] reason why not
bool CameraSource::open_again(std::string* reason) {
  try {
    const std::string path = find_again(io_, anchor_);
    if (path.empty()) {
      *reason = anchor_.path + " (" + anchor_.identity.card + " on " + anchor_.identity.bus +
                "): did not come back: plug it in and start again";
      return false;
    }
    std::vector<std::string> notes;  // told when it was opened first
    device_ = std::make_unique<Device>(io_, path, settings_, &controls_, &notes);
  } catch (const DeviceError& error) {
    *reason = error.what();
    return false;
  }
  if (device_->mode().width != mode_.width || device_->mode().height != mode_.height) {
    const std::string text = device_->path() + ": came back with images of " +
                             drivers::size_text(device_->mode().width, device_->mode().height) +
                             " instead of " + drivers::size_text(mode_.width, mode_.height) +
                             ": start again";
    give_up(text.c_str());
    return false;
  }
  capture_.use(device_.get());
  return true;
}

}  // namespace unisim::v4l2
