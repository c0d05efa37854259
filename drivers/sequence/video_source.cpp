// SPDX-License-Identifier: MIT
// Video files through OpenCV's videoio.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>
#include <utility>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_source.hpp"
#include "drivers/sequence/image_decoder.hpp"
#include "drivers/sequence/square_pixels.hpp"
#include "drivers/sequence/text_file.hpp"
#include "drivers/sequence/video_container.hpp"

namespace unisim::sequence {
namespace {

constexpr double kUsualFps = 30.0;
constexpr double kSlowest = 1e-3, kFastest = 1e6;  // what a container may say, time-lapse included
constexpr int64_t kCountSlack = 2;                 // containers estimate their number of frames

// FFmpeg writes to stderr by itself; OpenCV hands this variable on to it.
void silence_ffmpeg() { setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0); }

// FFmpeg plays plain text as a terminal recording.
bool is_text(const std::string& path) {
  char head[512] = {};
  std::ifstream file(path, std::ios::binary);
  file.read(head, sizeof head);
  return std::all_of(head, head + file.gcount(), [](char c) {
    return std::isprint(static_cast<unsigned char>(c)) ||
           std::isspace(static_cast<unsigned char>(c));
  });
}

cv::VideoCapture open_video(const std::string& path) {
  if (!is_file(path)) throw InputError(path + ": no such file: give a video file");
  silence_ffmpeg();
  if (is_text(path)) {
    throw InputError(path + ": empty or a text file: give a video file or a folder of images");
  }
  const bool ffmpeg = cv::videoio_registry::hasBackend(cv::CAP_FFMPEG);
  cv::VideoCapture video(path, ffmpeg ? cv::CAP_FFMPEG : cv::CAP_ANY);
  if (!video.isOpened()) {
    throw InputError(path +
                     ": not a video that can be played (cut off or unknown codec): try ffmpeg "
                     "-i FILE out.mp4");
  }
  return video;
}

class VideoSource final : public FrameSource {
 public:
  VideoSource(std::string path, cv::VideoCapture video, const SquarePixels& square, double fps,
              FrameRange range)
      : FrameSource("video", {}, square.notes(), square.rule()),
        path_(std::move(path)),
        video_(std::move(video)),
        square_(square),
        range_(range) {
    const double own_fps = video_.get(cv::CAP_PROP_FPS);
    own_times_ = fps <= 0;
    fps_ = fps > 0 ? fps : (own_fps >= kSlowest && own_fps <= kFastest ? own_fps : kUsualFps);
    const double total = video_.get(cv::CAP_PROP_FRAME_COUNT);
    total_ = total > 0 && total < 1e12 ? static_cast<int64_t>(total) : -1;
  }

 private:
  const std::string& frame_path() const override { return path_; }

  int64_t count() const override {
    if (total_ < 0) return -1;
    return std::max<int64_t>(0, std::min(total_, range_.to) - range_.from);
  }

  int read(int decode, unisim_frame* frame) override {
    if (ended_) return UNISIM_FRAME_END;
    bool grabbed = next_ < range_.to;
    do {
      grabbed = grabbed && video_.grab();
      if (grabbed) advance();
    } while (grabbed && next_ <= range_.from);
    if (!grabbed) return end();
    frame->index = next_ - 1;
    frame->timestamp_ns = timestamp_ns_;
    if (!in_time_order(frame->index, timestamp_ns_, path_)) return UNISIM_FRAME_BAD;
    return decode != 0 ? decode_last(frame) : UNISIM_FRAME_OK;
  }

  int decode_last(unisim_frame* frame) {
    std::string reason = "cannot be decoded";
    if (video_.retrieve(image_) && !image_.empty() && size_.fits(image_, &reason)) {
      frame->image = view_of(square_.apply(image_, &stretched_));
      return UNISIM_FRAME_OK;
    }
    return answer(UNISIM_FRAME_BAD, "frame " + std::to_string(next_ - 1) + ": " + path_ + ": " +
                                        reason + ": skipped");
  }

  // The container's time where it has one that grows. The last frames have none where frames are
  // stored in another order than shown: those go on as before them, else at the frame rate.
  void advance() {
    if (!own_times_) {
      timestamp_ns_ = time_at_rate(next_++, fps_);
      return;
    }
    const double own_ms = video_.get(cv::CAP_PROP_POS_MSEC);
    const int64_t own_ns = std::abs(own_ms * 1e6) <= kMaxTimeNs ? std::llround(own_ms * 1e6) : 0;
    if (next_ == 0) {
      timestamp_ns_ = own_ns;
    } else if (own_ns > timestamp_ns_) {
      step_ns_ = own_ns - timestamp_ns_;
      timestamp_ns_ = own_ns;
    } else {
      const int64_t step = step_ns_ > 0 ? step_ns_ : time_at_rate(1, fps_);
      // At the end of all times they repeat, which makes bad frames.
      if (timestamp_ns_ <= std::numeric_limits<int64_t>::max() - step) timestamp_ns_ += step;
    }
    ++next_;
  }

  int end() {
    ended_ = true;
    const int64_t expected = std::min(total_, range_.to);
    if (next_ + std::max(kCountSlack, expected / 100) >= expected) return UNISIM_FRAME_END;
    const ContainerFacts facts = read_container(path_);
    if (!facts.cut_off && !facts.counts_shown_frames) return UNISIM_FRAME_END;
    return answer(UNISIM_FRAME_BAD, "frame " + std::to_string(next_) + ": " + path_ +
                                        ": ends here, " + std::to_string(expected) +
                                        " frames were announced: file " +
                                        (facts.cut_off ? "cut off" : "damaged"));
  }

  std::string path_;
  cv::VideoCapture video_;
  SquarePixels square_;
  FrameRange range_;
  double fps_ = kUsualFps;
  bool own_times_ = true;
  int64_t total_ = -1;  // as the container says, -1 if it does not
  int64_t next_ = 0;    // position of the next frame to grab
  int64_t timestamp_ns_ = 0;
  int64_t step_ns_ = 0;  // between the last two frames with times of their own
  bool ended_ = false;
  cv::Mat image_;
  cv::Mat stretched_;
  SizeCheck size_;
};

bool recognise(const std::string& path) { return is_file(path) && !has_image_ending(path); }

std::unique_ptr<FrameSource> open(const OpenRequest& request, FrameRange range) {
  cv::VideoCapture video = open_video(request.path);
  const SquarePixels square = square_pixels(request.path, video);
  return std::make_unique<VideoSource>(request.path, std::move(video), square, request.fps, range);
}

}  // namespace

const Format kVideo = {"video", "a video file", recognise, nullptr, open};

}  // namespace unisim::sequence
