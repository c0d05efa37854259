// SPDX-License-Identifier: MIT
// Common part of the sources of this folder: the C table, frame range, time order, messages.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/sequence/pixel_rule.hpp"
#include "drivers/sequence/recording.hpp"
#include "drivers/source.h"

namespace unisim::sequence {

/// A unisim_source in C++: no exception leaves the functions of the table.
class FrameSource : public unisim_source {
 public:
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  const std::vector<std::string>& notes() const { return notes_; }
  const PixelRule& pixel_rule() const { return rule_; }

  /// File of the frame that came last.
  virtual const std::string& frame_path() const = 0;

 protected:
  FrameSource(const char* format_name, GroundTruth truth, std::vector<std::string> notes,
              const PixelRule& rule);

  virtual int64_t count() const = 0;
  /// @param decode as of unisim_source::next_frame()
  virtual int read(int decode, unisim_frame* frame) = 0;

  /// Sets message() and gives the status back.
  int answer(int status, std::string text);

  /// Checks that time grows from frame to frame. @return false with message() set if it does not
  bool in_time_order(int64_t index, int64_t timestamp_ns, const std::string& name);

 private:
  template <typename Call>
  int guarded(Call call);
  void fill_table();

  GroundTruth truth_;
  std::vector<std::string> notes_;
  PixelRule rule_;
  std::string message_;
  int64_t last_timestamp_ns_ = 0;
  bool any_frame_ = false;
};

/// Source over image files. @param range already clipped to the recording
std::unique_ptr<FrameSource> make_image_source(const char* format, Recording recording,
                                               FrameRange range);

}  // namespace unisim::sequence
