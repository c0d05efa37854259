// SPDX-License-Identifier: MIT
// Common part of the sources of this folder: the C table, frame range, time order, messages.
#include "drivers/sequence/frame_source.hpp"

#include <exception>
#include <utility>

#include "drivers/common/stamp_text.hpp"
#include "drivers/sequence/time_text.hpp"

namespace unisim::sequence {
namespace {

FrameSource* self(unisim_source* source) { return static_cast<FrameSource*>(source); }

}  // namespace

FrameSource::FrameSource(const char* format_name, GroundTruth truth, std::vector<std::string> notes,
                         const PixelRule& rule)
    : unisim_source{}, truth_(std::move(truth)), notes_(std::move(notes)), rule_(rule) {
  format = format_name;
  fill_table();
}

template <typename Call>
int FrameSource::guarded(Call call) {
  try {
    return call();
  } catch (const std::exception& error) {
    return answer(UNISIM_FRAME_FAILED, std::string("reading failed: ") + error.what());
  }
}

void FrameSource::fill_table() {
  struct_size = sizeof(unisim_source);
  frame_count = [](unisim_source* source) { return self(source)->count(); };
  next_frame = [](unisim_source* source, int decode, unisim_frame* frame) {
    *frame = {};
    return self(source)->guarded([&] { return self(source)->read(decode, frame); });
  };
  ground_truth = [](unisim_source* source, const unisim_stamped_pose** poses) {
    *poses = self(source)->truth_.poses.data();
    return static_cast<int64_t>(self(source)->truth_.poses.size());
  };
  ground_truth_path = [](unisim_source* source) { return self(source)->truth_.path.c_str(); };
  message = [](unisim_source* source) { return self(source)->message_.c_str(); };
  destroy = [](unisim_source* source) {
    if (source != nullptr) delete self(source);
  };
}

int FrameSource::answer(int status, std::string text) {
  message_ = std::move(text);
  return status;
}

bool FrameSource::in_time_order(int64_t index, int64_t timestamp_ns, const std::string& name) {
  if (any_frame_ && timestamp_ns <= last_timestamp_ns_) {
    const bool same = timestamp_ns == last_timestamp_ns_;
    answer(UNISIM_FRAME_BAD,
           "frame " + std::to_string(index) + ": " + name + ": time " +
               drivers::stamp_text(timestamp_ns) + " s" +
               (same ? " repeats"
                     : " goes back from " + drivers::stamp_text(last_timestamp_ns_) + " s") +
               ": skipped");
    return false;
  }
  any_frame_ = true;
  last_timestamp_ns_ = timestamp_ns;
  return true;
}

}  // namespace unisim::sequence
