// SPDX-License-Identifier: MIT
// Ranges of the configuration: every field has one, and the session's are those of the library.
#include <cmath>

#include "tests/support/catch.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/settings_fields.hpp"

using namespace unisim::replay;

namespace {

/// A configuration in which each field of [session] may take either end of its range.
Settings roomy_settings() {
  Settings settings = default_settings();
  settings.session.window_size = UNISIM_MAX_VIEWS;
  settings.session.window_overlap = 0;
  settings.session.max_keyframes = 65536;
  return settings;
}

unisim_status size_with(const std::string& name, double value) {
  Settings settings = roomy_settings();
  for (const Field& field : all_fields(&settings)) {
    if (field.name() != name) continue;
    if (auto* const* whole = std::get_if<int32_t*>(&field.target))
      **whole = static_cast<int32_t>(value);
    if (auto* const* bits = std::get_if<uint32_t*>(&field.target))
      **bits = static_cast<uint32_t>(static_cast<int64_t>(value));
    if (auto* const* real = std::get_if<double*>(&field.target)) **real = value;
  }
  size_t size = 0;
  return unisim_arena_size(&settings.session, &size);
}

}  // namespace

TEST_CASE("a value of no field's range is refused with file, line, field and range") {
  const TempFolder folder;
  Settings settings = default_settings();
  for (const Field& field : all_fields(&settings)) {
    for (const char* value : {"nan", "-inf", "inf", "-1", "1e300", "9000000000000000000", "\"8\"",
                              "[8]", "2001-01-01"}) {
      if (std::string(value) == "-1" && field.range.holds(-1.0)) continue;
      INFO(field.name() << " = " << value);
      const std::string path = folder.write(
          "run.toml", "# first line\n[" + field.section + "]\n" + field.key + " = " + value + "\n");
      std::string line;
      try {
        load_settings(path, &settings);
      } catch (const unisim::tools::Failure& failure) {
        CHECK(failure.code() == 2);
        line = failure.what();
      }
      CHECK(has(line, path + ":3: " + field.name() + " is "));
      CHECK(has(line, "must be "));
    }
  }
}

TEST_CASE("the ranges of [session] end where the library's end") {
  Settings settings = default_settings();
  for (const Field& field : all_fields(&settings)) {
    if (field.section != "session") continue;
    INFO(field.name());
    CHECK(size_with(field.name(), field.range.high()) == UNISIM_OK);
    if (field.range.holds(field.range.low())) {
      CHECK(size_with(field.name(), field.range.low()) == UNISIM_OK);
    }
    if (field.range.holds(0.0)) CHECK(size_with(field.name(), 0.0) == UNISIM_OK);
    const double below = field.range.is_whole() ? field.range.low() - 1.0 : -1e-9;
    if (below > 0.0 || field.range.low() < 2.0) {
      CHECK(size_with(field.name(), below) == UNISIM_ERR_INVALID_ARGUMENT);
    }
    if (field.range.is_whole()) {
      CHECK(size_with(field.name(), field.range.high() + 1.0) == UNISIM_ERR_INVALID_ARGUMENT);
    }
  }
}
