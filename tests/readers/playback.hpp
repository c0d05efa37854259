// SPDX-License-Identifier: MIT
// Writes small sequences and reads them back through the C table.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/sequence/sequence.h"
#include "tests/support/temp_folder.hpp"

/// One answer of next_frame().
struct Answer {
  int status;
  int64_t index;
  int64_t timestamp_ns;
  unisim_image image;  ///< data only tells whether there were pixels
  int pixel;           ///< first byte, -1 without pixels
  std::string message;
};

struct SourceDeleter {
  void operator()(unisim_source* source) const { source->destroy(source); }
};
using Source = std::unique_ptr<unisim_source, SourceDeleter>;

/// Opens or fails the test.
Source open_sequence(const std::string& path, const char* format = nullptr, int64_t from = 0,
                     int64_t to = 0, double fps = 0);

/// Message of an open that must fail.
std::string open_failure(const std::string& path, const char* format = nullptr, int64_t from = 0,
                         int64_t to = 0);

/// All answers before the end.
std::vector<Answer> play(const Source& source, bool decode = true);

std::vector<unisim_stamped_pose> truth_of(const Source& source);

/// What was noticed at opening, one text.
std::string notes_of(const Source& source);

/// An image of one brightness.
void write_image(const TempFolder& folder, const std::string& name, int brightness, int width = 32,
                 int height = 24, bool gray = false);

/// What `call` writes to stderr, libraries below included.
template <typename Call>
std::string stderr_of(Call call);

namespace detail {
class StderrCapture {
 public:
  StderrCapture();
  ~StderrCapture();
  std::string text();

 private:
  TempFolder folder_;
  int saved_;
};
}  // namespace detail

template <typename Call>
std::string stderr_of(Call call) {
  detail::StderrCapture capture;
  call();
  return capture.text();
}
