// SPDX-License-Identifier: MIT
// How every program begins and ends.
#include "tools/common/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <new>

#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"

namespace unisim::tools {
namespace {

/// A file opened later must not get the number of a stream that is closed, and the output with it.
/// What stands in fails when it is used.
void keep_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    const int mode = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", mode);
  }
}

int guarded(const char* name, const std::function<int()>& body) {
  try {
    return body();
  } catch (const Failure& failure) {
    complain(name, failure.what());
    return failure.code();
  } catch (const std::bad_alloc&) {
    complain(name, "out of memory");
    return kExitLimit;
  } catch (const std::exception& error) {
    complain(name, error.what());
    return kExitOther;
  }
}

}  // namespace

int run_program(const char* name, const std::function<int()>& body) {
  keep_standard_streams();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  const int code = guarded(name, body);
  const std::string problem = output_problem();
  if (problem.empty()) return code;
  complain(name, problem);
  return code == kExitDone ? kExitLimit : code;
}

}  // namespace unisim::tools
