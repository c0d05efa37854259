// SPDX-License-Identifier: MIT
// Another program beside the test.
#include "tests/lcm/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>

namespace unisim::testing {
namespace {

constexpr int kLookMs = 20;  // between two looks whether it has ended

}  // namespace

Child::Child(const std::vector<std::string>& command) : name_(command.at(0)) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("no process");
  if (pid_ == 0) {
    dup2(ends[1], STDOUT_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  close(ends[1]);
  output_ = ends[0];
}

Child::~Child() {
  if (pid_ > 0) {
    send_signal(SIGKILL);
    waitpid(pid_, &status_, 0);
  }
  close(output_);
}

std::string Child::line() {
  for (;;) {
    const size_t end = rest_.find('\n');
    if (end != std::string::npos) {
      const std::string first = rest_.substr(0, end);
      rest_.erase(0, end + 1);
      return first;
    }
    pollfd waiting = {output_, POLLIN, 0};
    char bytes[4096];
    if (poll(&waiting, 1, kPatienceMs) <= 0) return "";
    const ssize_t count = read(output_, bytes, sizeof bytes);
    if (count <= 0) return "";
    rest_.append(bytes, static_cast<size_t>(count));
  }
}

bool Child::wait_for(const std::string& begin, std::string* found) {
  for (std::string next = line(); !next.empty(); next = line()) {
    if (next.compare(0, begin.size(), begin) != 0) continue;
    if (found != nullptr) *found = next;
    return true;
  }
  return false;
}

void Child::send_signal(int signal) const { kill(pid_, signal); }

int Child::end(int patience_ms) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::milliseconds(patience_ms);
  for (bool open = true;;) {
    const pid_t ended = waitpid(pid_, &status_, WNOHANG);
    if (ended < 0 && errno != EINTR) throw std::runtime_error(name_ + " is no child");
    if (ended == pid_) break;
    if (Clock::now() > until) {
      send_signal(SIGKILL);
      waitpid(pid_, &status_, 0);
      pid_ = -1;
      throw std::runtime_error(name_ + " did not end within " + std::to_string(patience_ms) +
                               " ms and was killed");
    }
    open = drain(open);
  }
  pid_ = -1;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

bool Child::drain(bool open) {
  pollfd waiting = {output_, POLLIN, 0};
  // A closed pipe is always ready: it must not make this a busy loop.
  if (poll(&waiting, open ? 1 : 0, kLookMs) <= 0) return open;
  char bytes[4096];
  return read(output_, bytes, sizeof bytes) > 0;
}

bool told(int file) {
  char byte = 0;
  return read(file, &byte, 1) == 1;
}

}  // namespace unisim::testing
