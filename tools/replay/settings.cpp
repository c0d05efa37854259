// SPDX-License-Identifier: MIT
// The configuration of a run, from and to TOML.
#include "tools/replay/settings.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include "drivers/pipeline/session_defaults.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/settings_fields.hpp"

namespace unisim::replay {
namespace {

/// Insertions, deletions and changes of a letter that turn a into b.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string nearest_name(const std::vector<Field>& fields, const std::string& name) {
  const auto closer = [&](const Field& a, const Field& b) {
    return edit_distance(a.name(), name) < edit_distance(b.name(), name);
  };
  return std::min_element(fields.begin(), fields.end(), closer)->name();
}

/// Where a value stands and what it is called, for messages.
struct Place {
  std::string path;
  std::string name;
  unsigned line;

  tools::Failure failure(const std::string& what) const {
    return {tools::kExitUsage, path + ":" + std::to_string(line) + ": " + name + " " + what};
  }
};

/// As it stands in the file, where it is short enough to repeat.
std::string value_text(const toml::node& value) {
  std::ostringstream text;
  if (const auto* word = value.as_string()) text << '"' << word->get() << '"';
  if (const auto* whole = value.as_integer()) text << whole->get();
  if (const auto* real = value.as_floating_point()) text << real->get();
  if (const auto* flag = value.as_boolean()) text << (flag->get() ? "true" : "false");
  return text.str();
}

std::optional<double> number_in(const toml::node& value, const tools::Range& range) {
  if (!value.is_integer() && (range.is_whole() || !value.is_floating_point())) return std::nullopt;
  const auto number = value.value<double>();
  return number && range.holds(*number) ? number : std::nullopt;
}

void set_value(const toml::node& value, const Place& place, const Field& field) {
  const std::string is = "is " + value_text(value) + ", must be ";
  if (auto* const* flag = std::get_if<bool*>(&field.target)) {
    if (!value.is_boolean()) throw place.failure(is + "true or false");
    **flag = value.as_boolean()->get();
    return;
  }
  const auto number = number_in(value, field.range);
  if (!number) throw place.failure(is + field.range.text());
  if (auto* const* whole = std::get_if<int32_t*>(&field.target)) {
    **whole = static_cast<int32_t>(*number);
  } else if (auto* const* bits = std::get_if<uint32_t*>(&field.target)) {
    **bits = static_cast<uint32_t>(*number);
  } else {
    **std::get_if<double*>(&field.target) = *number;
  }
}

void set_section(const std::string& path, const std::string& section, const toml::table& table,
                 const std::vector<Field>& fields) {
  for (const auto& [key, value] : table) {
    const Place place = {path, section + "." + std::string(key.str()),
                         static_cast<unsigned>(value.source().begin.line)};
    const auto found = std::find_if(fields.begin(), fields.end(),
                                    [&](const Field& field) { return field.name() == place.name; });
    if (found == fields.end()) {
      throw place.failure("is not known; did you mean " + nearest_name(fields, place.name) + "?");
    }
    set_value(value, place, *found);
  }
}

toml::table parse_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw tools::Failure(tools::kExitUsage, path + ": a folder where a text file is expected");
  }
  try {
    return toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    const std::string what = ": " + std::string(error.description());
    if (line == 0) throw tools::Failure(tools::kExitInput, path + what);
    throw tools::Failure(tools::kExitUsage, path + ":" + std::to_string(line) + what);
  }
}

}  // namespace

Settings default_settings() {
  Settings settings{};
  if (unisim_config_init(&settings.session, sizeof settings.session) != UNISIM_OK) {
    throw tools::Failure(tools::kExitOther,
                         "this program and libunisim do not fit together: rebuild both");
  }
  settings.session.window_submaps = pipeline::kSlidingSubmaps;
  unisim_geometric_config_init(&settings.geometric, sizeof settings.geometric);
  unisim_onnx_config_init(&settings.onnx, sizeof settings.onnx);
  return settings;
}

void load_settings(const std::string& path, Settings* settings) {
  const toml::table file = parse_file(path);
  const std::vector<Field> fields = all_fields(settings);
  for (const auto& [key, value] : file) {
    const std::string section(key.str());
    if (!value.is_table()) {
      const Place place = {path, section, static_cast<unsigned>(value.source().begin.line)};
      throw place.failure(
          "stands outside of [session], [pipeline], [geometric] and [onnx]; did you mean " +
          nearest_name(fields, section) + "?");
    }
    set_section(path, section, *value.as_table(), fields);
  }
  if (file.at_path("session.window_size")) settings->window_size_given = true;
  if (file.at_path("session.window_overlap")) settings->window_overlap_given = true;
  if (file.at_path("session.max_keyframes")) settings->max_keyframes_given = true;
}

void check_together(const Settings& settings) {
  const auto require = [](bool good, const std::string& line) {
    if (!good) throw tools::Failure(tools::kExitUsage, line);
  };
  const unisim_config& session = settings.session;
  const pipeline::KeyframeConfig& keyframes = settings.pipeline.keyframes;
  require(session.window_overlap < session.window_size,
          "session.window_overlap (--overlap) is " + std::to_string(session.window_overlap) +
              ", must be less than session.window_size (--window), " +
              std::to_string(session.window_size));
  require(keyframes.max_gap >= keyframes.min_gap,
          "pipeline.max_gap is " + std::to_string(keyframes.max_gap) +
              ", must be at least pipeline.min_gap, " + std::to_string(keyframes.min_gap));
  require(!settings.max_keyframes_given || session.max_keyframes >= least_keyframes(session),
          "session.max_keyframes is " + std::to_string(session.max_keyframes) +
              ", must be at least " + std::to_string(least_keyframes(session)) +
              " with session.window_submaps " + std::to_string(session.window_submaps));
}

int32_t least_keyframes(const unisim_config& session) {
  constexpr int32_t kWaitingWindows = 9;  // as stated at unisim_config.max_keyframes
  if (session.window_submaps == 0) return 2;
  return (session.window_submaps + kWaitingWindows) * session.window_size;
}

std::string settings_text(const Settings& settings) {
  std::ostringstream out;
  Settings copy = settings;
  std::string section;
  for (const Field& field : all_fields(&copy)) {
    if (field.section != section) {
      out << (section.empty() ? "[" : "\n[") << field.section << "]\n";
      section = field.section;
    }
    out << field.key << " = ";
    std::visit(
        [&](auto* target) {
          using Value = std::remove_pointer_t<decltype(target)>;
          if constexpr (std::is_same_v<Value, uint32_t>) {
            out << toml::value<int64_t>(*target);
          } else if constexpr (std::is_same_v<Value, int32_t>) {
            out << toml::value<int64_t>(*target);
          } else {
            out << toml::value<Value>(*target);
          }
        },
        field.target);
    out << "\n";
  }
  return out.str();
}

}  // namespace unisim::replay
