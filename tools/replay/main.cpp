// SPDX-License-Identifier: MIT
// unisim-replay: a recorded sequence becomes a trajectory, a map and honest figures.
#include <exception>
#include <iostream>
#include <new>

#include "tools/replay/failure.hpp"
#include "tools/replay/interrupt.hpp"
#include "tools/replay/options.hpp"
#include "tools/replay/replay.hpp"

namespace {

int run(int argc, const char* const* argv) {
  const std::atomic<bool>& stop = unisim::replay::catch_interrupts();
  const auto options = unisim::replay::parse_options(argc, argv);
  if (!options) return unisim::replay::kExitDone;
  if (options->print_config) {
    unisim::replay::print_settings(options->settings, std::cout);
    return unisim::replay::kExitDone;
  }
  return unisim::replay::replay(*options, stop);
}

int fail(int code, const char* line) {
  std::cerr << "unisim-replay: " << line << "\n";
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const unisim::replay::Failure& failure) {
    return fail(failure.code(), failure.what());
  } catch (const std::bad_alloc&) {
    return fail(unisim::replay::kExitLimit, "out of memory");
  } catch (const std::exception& error) {
    return fail(unisim::replay::kExitOther, error.what());
  }
}
