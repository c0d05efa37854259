// SPDX-License-Identifier: MIT
// Another program beside the test, heard line by line.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace unisim::testing {

/// Started with its output in a pipe; killed at the end where it still runs.
class Child {
 public:
  explicit Child(const std::vector<std::string>& command);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Next line of its output; "" when there is no more, or none for long.
  std::string line();
  /// Lines up to one that begins so. false: it never came
  bool wait_for(const std::string& begin, std::string* found = nullptr);
  void send_signal(int signal) const;
  /// Waits for its end and throws away what it still says. @return exit code, 128 + n when signal n
  /// ended it
  /// Throws when it has not ended by then, after killing it.
  int end(int patience_ms = kPatienceMs);

 private:
  // Far beyond what any line takes; a hang must not stop the test run.
  static constexpr int kPatienceMs = 60000;

  /// Reads for a moment. @return whether there may be more
  bool drain(bool open);

  std::string name_;
  pid_t pid_ = -1;
  int output_ = -1;
  std::string rest_;
  int status_ = 0;
};

/// Waits for a byte from a pipe. false: its other end is closed
bool told(int file);

}  // namespace unisim::testing
