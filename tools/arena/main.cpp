// SPDX-License-Identifier: MIT
// unisim-arena: the exact bytes a session needs, by part.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tools/replay/failure.hpp"
#include "tools/replay/settings.hpp"
#include "tools/replay/version.hpp"

namespace {

using unisim::replay::Failure;

std::vector<unisim_arena_part> parts_of(const unisim_config& config) {
  size_t count = 0;
  unisim_status status = unisim_arena_parts(&config, nullptr, 0, &count);
  std::vector<unisim_arena_part> parts(status == UNISIM_ERR_CAPACITY ? count : 0);
  if (!parts.empty()) status = unisim_arena_parts(&config, parts.data(), parts.size(), &count);
  if (status != UNISIM_OK) {
    throw Failure(unisim::replay::kExitUsage,
                  "a value of [session] is out of range: see the ranges in unisim/unisim.h");
  }
  return parts;
}

void print(const unisim_config& config) {
  size_t total = 0;
  for (const unisim_arena_part& part : parts_of(config)) {
    std::printf("%-16s %12zu\n", part.name, part.bytes);
    total += part.bytes;
  }
  std::printf("%-16s %12zu\n", "total", total);
}

int fail(int code, const char* line) {
  std::fprintf(stderr, "unisim-arena: %s\n", line);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  CLI::App app("Print the exact bytes a session needs, by part.");
  app.set_version_flag("--version", unisim::replay::version_text());
  app.add_option("--config", file, "TOML file as of unisim-replay --config; its [session] counts");
  try {
    app.parse(argc, argv);
    unisim::replay::Settings settings = unisim::replay::default_settings();
    if (!file.empty()) unisim::replay::load_settings(file, &settings);
    print(settings.session);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return fail(unisim::replay::kExitUsage, error.what());
  } catch (const Failure& failure) {
    return fail(failure.code(), failure.what());
  } catch (const std::exception& error) {
    return fail(unisim::replay::kExitOther, error.what());
  }
  return unisim::replay::kExitDone;
}
