// SPDX-License-Identifier: MIT
// What the programs say.
#include "tools/common/output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <system_error>

#include "tools/common/text.hpp"

namespace unisim::tools {
namespace {

int lost_reason = 0;  // errno of the first write to stdout that failed

/// @return false when the write failed for good
bool wait_for_room() {
  if (errno == EINTR) return true;
  if (errno != EAGAIN) return false;
  pollfd out = {STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, -1) >= 0 || errno == EINTR;
}

}  // namespace

void print(const std::string& text) {
  size_t done = 0;
  while (done < text.size() && lost_reason == 0) {
    const ssize_t count = write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (count > 0)
      done += static_cast<size_t>(count);
    else if (!wait_for_room())
      lost_reason = errno;
  }
}

std::string output_problem() {
  if (lost_reason == 0 || lost_reason == EPIPE) return {};
  return "output lost: " + std::generic_category().message(lost_reason);
}

void complain(const char* program, const std::string& line) {
  std::cerr << program << ": " << one_line(line) << "\n";
}

}  // namespace unisim::tools
