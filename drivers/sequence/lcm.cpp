// SPDX-License-Identifier: MIT
// Reader of LCM event logs: images of one channel. Needs no LCM.
#include <algorithm>
#include <fstream>
#include <utility>

#include "drivers/sequence/folder.hpp"
#include "drivers/sequence/frame_source.hpp"
#include "drivers/sequence/lcm_image.hpp"
#include "drivers/sequence/lcm_log.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

class LogSource final : public FrameSource {
 public:
  LogSource(std::string path, LcmLog log, FrameRange range)
      : FrameSource("lcm", {}, std::move(log.notes), {}),
        path_(std::move(path)),
        file_(path_, std::ios::binary),
        images_(std::move(log.images)),
        range_(range),
        next_(range.from) {}

 private:
  const std::string& frame_path() const override { return path_; }

  int64_t count() const override { return range_.to - range_.from; }

  int read(int decode, unisim_frame* frame) override {
    if (next_ >= range_.to) return UNISIM_FRAME_END;
    frame->index = next_++;
    const LoggedImage& image = images_[static_cast<size_t>(frame->index)];
    frame->timestamp_ns = image.timestamp_ns;
    if (!in_time_order(frame->index, image.timestamp_ns, path_)) return UNISIM_FRAME_BAD;
    return decode != 0 ? decode_message(image, frame) : UNISIM_FRAME_OK;
  }

  int decode_message(const LoggedImage& image, unisim_frame* frame) {
    std::string reason = "cannot be read";
    bytes_.resize(static_cast<size_t>(image.size));
    file_.clear();
    file_.seekg(image.offset);
    file_.read(reinterpret_cast<char*>(bytes_.data()), image.size);
    ImageMessage stored{};
    if (file_ && parse_image_message(bytes_.data(), bytes_.size(), &stored, &reason) &&
        decoder_.decode(stored, &frame->image, &reason)) {
      return UNISIM_FRAME_OK;
    }
    return answer(UNISIM_FRAME_BAD, "frame " + std::to_string(frame->index) + ": " + path_ +
                                        ": message at offset " + std::to_string(image.offset) +
                                        " " + reason + ": skipped");
  }

  std::string path_;
  std::ifstream file_;
  std::vector<LoggedImage> images_;
  FrameRange range_;
  int64_t next_;
  std::vector<uint8_t> bytes_;
  MessageDecoder decoder_;
};

bool recognise(const std::string& path) { return is_file(path) && begins_as_lcm_log(path); }

std::unique_ptr<FrameSource> open(const OpenRequest& request, FrameRange range) {
  LcmLog log = list_lcm_log(request.path, request.channel);
  const auto count = static_cast<int64_t>(log.images.size());
  check_begin(request.path, count, range.from);
  range.to = std::min(range.to, count);
  return std::make_unique<LogSource>(request.path, std::move(log), range);
}

}  // namespace

const Format kLcm = {"lcm", "an LCM event log", recognise, nullptr, open};

}  // namespace unisim::sequence
