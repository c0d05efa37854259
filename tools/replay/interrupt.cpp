// SPDX-License-Identifier: MIT
// Ctrl-C and termination as a flag.
#include "tools/replay/interrupt.hpp"

#include <csignal>

namespace unisim::replay {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only use such");

extern "C" void on_signal(int) { interrupted.store(true); }

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  struct sigaction action{};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup{};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler == SIG_IGN) return interrupted;
  action.sa_flags = SA_RESTART;
  sigaction(SIGHUP, &action, nullptr);
  return interrupted;
}

}  // namespace unisim::replay
