// SPDX-License-Identifier: MIT
// unisim-synth: renders a sequence with exact ground truth.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"
#include "tools/common/program.hpp"
#include "tools/synth/sequence.hpp"

namespace {

using unisim::synth::SequenceOptions;
using unisim::tools::in_range;
using unisim::tools::Range;

constexpr int64_t kLargestSeed = 1000000000000000;  // exact as a double too

void parse_size(const std::string& text, SequenceOptions* options) {
  int read = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &options->width, &options->height, &read) != 2 ||
      read != static_cast<int>(text.size())) {
    throw unisim::tools::Failure(unisim::tools::kExitUsage,
                                 "--size must look like 640x480, not " + text);
  }
}

void run(const SequenceOptions& options, bool quiet) {
  const bool counting = !quiet && isatty(STDERR_FILENO) != 0;
  unisim::synth::write_sequence(options, [&](int done) {
    if (counting) std::fprintf(stderr, "\r%d of %d frames", done, options.frames);
  });
  if (counting) std::fprintf(stderr, "\r");
  if (!quiet) {
    unisim::tools::print(std::to_string(options.frames) + " frames of " + options.scene + ", " +
                         std::to_string(options.width) + "x" + std::to_string(options.height) +
                         ", in " + options.folder + "\n");
  }
}

int synth(int argc, const char* const* argv) {
  SequenceOptions options;
  std::string size = "640x480";
  bool quiet = false;
  CLI::App app("Render a textured scene with exact ground truth into a TUM-style folder.");
  app.set_version_flag("--version", UNISIM_SYNTH_VERSION);
  app.add_option("OUT", options.folder, "folder to write, made if absent")->required();
  app.add_option("--scene", options.scene, "room corridor desk rotation lowtexture static")
      ->capture_default_str();
  app.add_option("--frames", options.frames, "number of frames")
      ->transform(in_range(Range::whole(1, 1000000)))
      ->capture_default_str();
  app.add_option("--size", size, "image size, WxH")->capture_default_str();
  app.add_option("--loops", options.loops, "rounds of the path; 0: open path [1; corridor 0]")
      ->transform(in_range(Range::whole(0, 1000)));
  app.add_option("--seed", options.seed, "of scene, path and noise")
      ->transform(in_range(Range::whole(0, kLargestSeed)))
      ->capture_default_str();
  app.add_option("--focal", options.focal_px, "focal length in pixels [0.82 x width]")
      ->transform(in_range(Range::above(0.0, 1e6)));
  app.add_option("--radial", options.radial_k1, "radial distortion term k1")
      ->transform(in_range(Range::number(-0.2, 0.2)))
      ->capture_default_str();
  app.add_option("--fps", options.fps, "frames per second")
      ->transform(in_range(Range::above(0.0, 1000.0)))
      ->capture_default_str();
  app.add_flag("--blur", options.blur, "motion blur of half the frame time");
  app.add_option("--readout-ms", options.readout_ms,
                 "rolling shutter: from the first row to the last; negative: from below")
      ->transform(in_range(Range::number(-1000.0, 1000.0)))
      ->capture_default_str();
  app.add_flag("--noise", options.noise, "sensor noise");
  app.add_flag("--exposure", options.exposure_jumps, "jumps of exposure");
  app.add_flag("--jpg", options.jpeg, "color images as JPEG, quality 95, in place of PNG");
  app.add_flag("--encode", options.encode, "depth and pose written into the pixels, see README");
  app.add_option("--unit-spread", options.unit_spread,
                 "with --encode: spread of the unit of length from inference to inference")
      ->transform(in_range(Range::number(0.0, 0.999)))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "0: one per core")
      ->transform(in_range(Range::whole(0, 256)))
      ->capture_default_str();
  app.add_flag("--force", options.force, "replace an earlier sequence in OUT");
  app.add_flag("--quiet", quiet, "print nothing but errors");
  if (!unisim::tools::parse(&app, argc, argv)) return unisim::tools::kExitDone;
  parse_size(size, &options);
  run(options, quiet);
  return unisim::tools::kExitDone;
}

}  // namespace

int main(int argc, char** argv) {
  return unisim::tools::run_program("unisim-synth", [&] { return synth(argc, argv); });
}
