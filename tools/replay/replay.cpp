// SPDX-License-Identifier: MIT
// One run of unisim-replay.
#include "tools/replay/replay.hpp"

#include "tools/replay/run.hpp"
#include "tools/replay/scores.hpp"

namespace unisim::replay {
namespace {

Input open_recording(const Options& options) {
  Input input;
  input.source = open_sequence(options, &input.notes);
  input.truth = load_ground_truth(options.ground_truth, input.source.get());
  input.notes.insert(input.notes.end(), input.truth.notes.begin(), input.truth.notes.end());
  return input;
}

}  // namespace

int replay(const Options& options, const std::atomic<bool>& stop) {
  Surroundings around;
  around.open = [&] { return open_recording(options); };
  return run(options, around, stop);
}

}  // namespace unisim::replay
