// SPDX-License-Identifier: MIT
// Runs the programs under test.
#include "tests/replay/program.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace unisim::testing {
namespace {

using Clock = std::chrono::steady_clock;

// Far beyond what any of these runs takes; a hang must not stop the test run.
constexpr int kPatienceSeconds = 120;

void redirect(int stream, const std::string& path) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0 || dup2(file, stream) < 0) _exit(126);
}

void close_reader(int stream) {
  int ends[2];
  if (pipe(ends) != 0 || dup2(ends[1], stream) < 0) _exit(126);
  close(ends[0]);
  close(ends[1]);
}

[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments,
                         const std::string& out, const std::string& err,
                         const Disturbance& disturbance) {
  if (disturbance.max_file_bytes >= 0) {
    const auto bytes = static_cast<rlim_t>(disturbance.max_file_bytes);
    const rlimit limit = {bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  redirect(STDOUT_FILENO, disturbance.reader == Reader::kFullDevice ? "/dev/full" : out);
  redirect(STDERR_FILENO, err);
  if (disturbance.reader == Reader::kGone) {
    close_reader(STDOUT_FILENO);
    close_reader(STDERR_FILENO);
  }
  std::signal(SIGHUP, disturbance.hangup_ignored ? SIG_IGN : SIG_DFL);
  execv(program.c_str(), argv.data());
  _exit(127);
}

bool time_to_interrupt(const Disturbance& disturbance, const std::string& out) {
  return !disturbance.interrupt_on.empty() &&
         read_file(out).find(disturbance.interrupt_on) != std::string::npos;
}

int wait_for(pid_t child, const Disturbance& disturbance, const std::string& out) {
  const Clock::time_point start = Clock::now();
  bool interrupted = false;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    const Clock::duration elapsed = Clock::now() - start;
    if (!interrupted && time_to_interrupt(disturbance, out)) {
      interrupted = true;
      kill(child, disturbance.signal);
    }
    if (elapsed > std::chrono::seconds(kPatienceSeconds)) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          const Disturbance& disturbance) {
  const TempFolder folder;
  const std::string out = folder / "out";
  const std::string err = folder / "err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot start " + program);
  if (child == 0) become(program, arguments, out, err, disturbance);
  ProgramResult result;
  result.code = wait_for(child, disturbance, out);
  result.out = read_file(out);
  result.err = read_file(err);
  return result;
}

ProgramResult run_replay(const std::vector<std::string>& arguments,
                         const Disturbance& disturbance) {
  return run_program(UNISIM_REPLAY_PROGRAM, arguments, disturbance);
}

std::string rendered_sequence() { return UNISIM_RENDERED "/320x240"; }

std::string rolling_sequence() { return UNISIM_RENDERED "/rolling"; }

std::string small_sequence() { return UNISIM_RENDERED "/160x120"; }

std::string still_sequence() { return UNISIM_RENDERED "/still"; }

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
}

}  // namespace unisim::testing
