// SPDX-License-Identifier: MIT
// Source over a list of image files.
#include <utility>

#include "drivers/sequence/frame_source.hpp"
#include "drivers/sequence/image_decoder.hpp"

namespace unisim::sequence {
namespace {

class ImageSource final : public FrameSource {
 public:
  ImageSource(const char* format_name, Recording recording, FrameRange range, const PixelRule& rule)
      : FrameSource(format_name, std::move(recording.truth), std::move(recording.notes), rule),
        frames_(std::move(recording.frames)),
        range_(range),
        next_(range.from),
        decoder_(rule) {}

 private:
  const std::string& frame_path() const override {
    static const std::string none;
    return next_ == range_.from ? none : frames_[static_cast<size_t>(next_ - 1)].path;
  }

  int64_t count() const override { return range_.to - range_.from; }

  int read(int decode, unisim_frame* frame) override {
    if (next_ >= range_.to) return UNISIM_FRAME_END;
    frame->index = next_++;
    const FrameEntry& entry = frames_[static_cast<size_t>(frame->index)];
    frame->timestamp_ns = entry.timestamp_ns;
    return decode != 0 ? decode_last(decode, frame) : UNISIM_FRAME_OK;
  }

  int decode_last(int decode, unisim_frame* frame) {
    const std::string& path = frames_[static_cast<size_t>(next_ - 1)].path;
    std::string reason;
    if (decoder_.decode(path, &frame->image, &reason)) return UNISIM_FRAME_OK;
    const std::string what = "frame " + std::to_string(next_ - 1) + ": " + path + ": " + reason;
    if (decode == UNISIM_DECODE_IF_READABLE) return answer(UNISIM_FRAME_OK, what);
    return answer(UNISIM_FRAME_BAD, what + ": skipped");
  }

  std::vector<FrameEntry> frames_;
  FrameRange range_;
  int64_t next_;
  ImageDecoder decoder_;
};

}  // namespace

std::unique_ptr<FrameSource> make_image_source(const char* format, Recording recording,
                                               FrameRange range) {
  std::vector<std::string> paths;
  for (int64_t i = range.from; i < range.to; ++i) {
    paths.push_back(recording.frames[static_cast<size_t>(i)].path);
  }
  const PixelRule rule = learn_pixel_rule(paths);
  const std::string note = pixel_note(rule);
  if (!note.empty()) add_note(&recording, note);
  return std::make_unique<ImageSource>(format, std::move(recording), range, rule);
}

}  // namespace unisim::sequence
