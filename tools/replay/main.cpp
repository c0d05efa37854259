// SPDX-License-Identifier: MIT
// unisim-replay: a recorded sequence becomes a trajectory, a map and honest figures.
#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"
#include "tools/common/program.hpp"
#include "tools/replay/frame_list.hpp"
#include "tools/replay/interrupt.hpp"
#include "tools/replay/options.hpp"
#include "tools/replay/replay.hpp"

namespace unisim::replay {
namespace {

int run(int argc, const char* const* argv) {
  const std::atomic<bool>& stop = catch_interrupts();
  const auto options = parse_options(argc, argv);
  if (!options) return tools::kExitDone;
  if (options->print_config) {
    tools::print(settings_text(options->settings));
    return tools::kExitDone;
  }
  return options->list_frames ? list_frames(*options, stop) : replay(*options, stop);
}

}  // namespace
}  // namespace unisim::replay

int main(int argc, char** argv) {
  return unisim::tools::run_program(unisim::replay::kProgramName,
                                    [&] { return unisim::replay::run(argc, argv); });
}
