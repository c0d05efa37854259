// SPDX-License-Identifier: MIT
// The configuration of a run, from and to TOML.
#include "tools/replay/settings.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <variant>
#include <vector>

#include "tools/common/failure.hpp"

namespace unisim::replay {
namespace {

// Submaps of the sliding window: with the usual overlap as many keyframes as the geometric
// predictor holds (180), since what it measures better of a submap that has left is lost. With 2
// redkitchen ends at 0.0079 m (frames 0-499), with 8 at 0.0074, with 24 at 0.0068, where the full
// batch does. An update takes twice the time it takes with 2, the arena half as much again.
constexpr int32_t kSlidingSubmaps = 24;

using Target = std::variant<int32_t*, uint32_t*, double*, bool*>;

struct Field {
  std::string section;
  std::string key;
  Target target;

  std::string name() const { return section + "." + key; }
};

void add_session_fields(unisim_config* c, std::vector<Field>* fields) {
  const char* s = "session";
  fields->insert(fields->end(), {{s, "preset", &c->preset},
                                 {s, "window_size", &c->window_size},
                                 {s, "window_overlap", &c->window_overlap},
                                 {s, "max_keyframes", &c->max_keyframes},
                                 {s, "max_submaps", &c->max_submaps},
                                 {s, "max_loops", &c->max_loops},
                                 {s, "depth_grid_width", &c->depth_grid_width},
                                 {s, "depth_grid_height", &c->depth_grid_height},
                                 {s, "disabled_factors", &c->disabled_factors},
                                 {s, "weight_two_view", &c->weight_two_view},
                                 {s, "weight_bridge", &c->weight_bridge},
                                 {s, "weight_scale_anchor", &c->weight_scale_anchor},
                                 {s, "weight_tie", &c->weight_tie},
                                 {s, "weight_scale", &c->weight_scale},
                                 {s, "huber_delta", &c->huber_delta},
                                 {s, "loop_delta", &c->loop_delta},
                                 {s, "live_scale_exponent", &c->live_scale_exponent},
                                 {s, "confidence_drop", &c->confidence_drop},
                                 {s, "sigma_reference", &c->sigma_reference},
                                 {s, "sigma_gate", &c->sigma_gate},
                                 {s, "sigma_gate_loop", &c->sigma_gate_loop},
                                 {s, "scatter_gate", &c->scatter_gate},
                                 {s, "loop_gate", &c->loop_gate},
                                 {s, "window_submaps", &c->window_submaps},
                                 {s, "skeleton_capacity", &c->skeleton_capacity},
                                 {s, "lost_after", &c->lost_after},
                                 {s, "max_iterations", &c->max_iterations}});
}

void add_pipeline_fields(pipeline::Options* o, std::vector<Field>* fields) {
  const char* s = "pipeline";
  fields->insert(fields->end(), {{s, "stride", &o->keyframes.stride},
                                 {s, "flow", &o->keyframes.flow},
                                 {s, "tracked", &o->keyframes.tracked},
                                 {s, "min_gap", &o->keyframes.min_gap},
                                 {s, "max_gap", &o->keyframes.max_gap},
                                 {s, "queue_frames", &o->queue_frames},
                                 {s, "every_frame", &o->every_frame},
                                 {s, "realtime", &o->realtime}});
}

void add_geometric_fields(unisim_geometric_config* c, std::vector<Field>* fields) {
  const char* s = "geometric";
  fields->insert(fields->end(), {{s, "max_tracks", &c->max_tracks},
                                 {s, "max_keyframes", &c->max_keyframes},
                                 {s, "max_landmarks", &c->max_landmarks},
                                 {s, "max_window_views", &c->max_window_views},
                                 {s, "window_size", &c->window_size},
                                 {s, "adjust_every", &c->adjust_every},
                                 {s, "adjust_latency", &c->adjust_latency},
                                 {s, "background", &c->background},
                                 {s, "revive_age", &c->revive_age},
                                 {s, "revive_tries", &c->revive_tries},
                                 {s, "focal_px", &c->focal_px}});
}

void add_onnx_fields(unisim_onnx_config* c, std::vector<Field>* fields) {
  const char* s = "onnx";
  fields->insert(fields->end(), {{s, "threads", &c->threads},
                                 {s, "memory_mb", &c->memory_mb},
                                 {s, "keyframe_interval", &c->keyframe_interval},
                                 {s, "min_pose_confidence", &c->min_pose_confidence}});
}

std::vector<Field> all_fields(Settings* settings) {
  std::vector<Field> fields;
  add_session_fields(&settings->session, &fields);
  add_pipeline_fields(&settings->pipeline, &fields);
  add_geometric_fields(&settings->geometric, &fields);
  add_onnx_fields(&settings->onnx, &fields);
  return fields;
}

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

template <typename Integer>
void set_integer(const toml::node& value, const Place& place, Integer* target) {
  const auto number = value.value_exact<int64_t>();
  if (!number) throw place.failure("must be a whole number");
  const bool fits = *number >= int64_t{std::numeric_limits<Integer>::min()} &&
                    *number <= int64_t{std::numeric_limits<Integer>::max()};
  if (!fits) throw place.failure("is out of range");
  *target = static_cast<Integer>(*number);
}

void set_value(const toml::node& value, const Place& place, const Target& target) {
  if (auto* const* whole = std::get_if<int32_t*>(&target)) return set_integer(value, place, *whole);
  if (auto* const* bits = std::get_if<uint32_t*>(&target)) return set_integer(value, place, *bits);
  if (auto* const* real = std::get_if<double*>(&target)) {
    const auto number = value.value<double>();
    if (!number || !value.is_number()) throw place.failure("must be a number");
    **real = *number;
    return;
  }
  const auto flag = value.value_exact<bool>();
  if (!flag) throw place.failure("must be true or false");
  *std::get<bool*>(target) = *flag;
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
    set_value(value, place, found->target);
  }
}

toml::table parse_file(const std::string& path) {
  try {
    return toml::parse_file(path);
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    const std::string where = line > 0 ? path + ":" + std::to_string(line) : path;
    throw tools::Failure(tools::kExitInput, where + ": " + std::string(error.description()));
  }
}

}  // namespace

Settings default_settings() {
  Settings settings{};
  if (unisim_config_init(&settings.session, sizeof settings.session) != UNISIM_OK) {
    throw tools::Failure(tools::kExitOther,
                         "this program and libunisim do not fit together: rebuild both");
  }
  settings.session.window_submaps = kSlidingSubmaps;
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
