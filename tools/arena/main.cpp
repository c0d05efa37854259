// SPDX-License-Identifier: MIT
// unisim-arena: the exact bytes a session needs, by part.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "drivers/common/format.hpp"
#include "tools/common/command_line.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/output.hpp"
#include "tools/common/program.hpp"
#include "tools/replay/settings.hpp"
#include "tools/replay/version.hpp"

namespace {

using unisim::tools::Failure;

std::vector<unisim_arena_part> parts_of(const unisim_config& config) {
  size_t count = 0;
  unisim_status status = unisim_arena_parts(&config, nullptr, 0, &count);
  std::vector<unisim_arena_part> parts(status == UNISIM_ERR_CAPACITY ? count : 0);
  if (!parts.empty()) status = unisim_arena_parts(&config, parts.data(), parts.size(), &count);
  if (status != UNISIM_OK) {
    throw Failure(unisim::tools::kExitOther,
                  std::string("session: ") + unisim_status_string(status));
  }
  return parts;
}

void print(const unisim_config& config) {
  size_t total = 0;
  std::string text;
  for (const unisim_arena_part& part : parts_of(config)) {
    text += unisim::drivers::format("%-16s %12zu\n", part.name, part.bytes);
    total += part.bytes;
  }
  unisim::tools::print(text + unisim::drivers::format("%-16s %12zu\n", "total", total));
}

int arena(int argc, const char* const* argv) {
  std::string file;
  CLI::App app("Print the exact bytes a session needs, by part.");
  app.set_version_flag("--version", unisim::replay::version_text());
  app.add_option("--config", file, "TOML file as of unisim-replay --config; its [session] counts");
  if (!unisim::tools::parse(&app, argc, argv)) return unisim::tools::kExitDone;
  unisim::replay::Settings settings = unisim::replay::default_settings();
  if (!file.empty()) unisim::replay::load_settings(file, &settings);
  settings.max_keyframes_given = true;  // there is no sequence that it could follow from
  unisim::replay::check_together(settings);
  print(settings.session);
  return unisim::tools::kExitDone;
}

}  // namespace

int main(int argc, char** argv) {
  return unisim::tools::run_program("unisim-arena", [&] { return arena(argc, argv); });
}
