// SPDX-License-Identifier: MIT
// How the system runs this process.
#include "tools/live/scheduling.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "tools/common/failure.hpp"

namespace unisim::live {
namespace {

[[noreturn]] void fail(const std::string& option, const std::string& advice) {
  throw tools::Failure(tools::kExitLimit, option + ": " + std::strerror(errno) +
                                              (advice.empty() ? "" : "; ") + advice);
}

void pin(const std::vector<int>& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<size_t>(cpu), &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) return;
  if (errno == EINVAL) {
    throw tools::Failure(tools::kExitUsage,
                         "--cpus: none of these processors is there for this process; `nproc` and "
                         "/proc/cpuinfo list them from 0");
  }
  fail("--cpus", "");
}

}  // namespace

void apply(const Scheduling& scheduling) {
  if (!scheduling.cpus.empty()) pin(scheduling.cpus);
  if (scheduling.priority) {
    sched_param parameter{};
    parameter.sched_priority = *scheduling.priority;
    if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0) {
      fail("--priority",
           "allow it by `setcap cap_sys_nice=ep` on this program, or LimitRTPRIO= "
           "of its systemd unit");
    }
  }
  if (scheduling.lock_memory && mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    fail("--lock-memory",
         "allow it by `ulimit -l unlimited`, or LimitMEMLOCK= of its systemd unit");
  }
}

void share_as_usual() {
  // Cannot fail for a thread that asks for less than it has.
  const sched_param usual{};
  sched_setscheduler(0, SCHED_OTHER, &usual);
}

void give_way() {
  share_as_usual();
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);
}

}  // namespace unisim::live
