// SPDX-License-Identifier: MIT
// Maps that outlive the run.
#include "tools/replay/maps.hpp"

#include <filesystem>

#include "drivers/common/size_text.hpp"
#include "drivers/pipeline/map_saving.hpp"
#include "tools/common/failure.hpp"
#include "tools/replay/version.hpp"

namespace unisim::replay {
namespace {

namespace fs = std::filesystem;

tools::Failure failure(const mapfile::Error& error) {
  const bool input = error.kind() == mapfile::Error::Kind::kInput;
  return {input ? tools::kExitInput : tools::kExitLimit, error.what()};
}

/// A map that is gone on with may be replaced by what comes of it.
void check_saving(const Options& options) {
  std::error_code ignored;
  const bool own =
      !options.load_map.empty() && fs::equivalent(options.save_map, options.load_map, ignored);
  if (!options.force && !own && fs::exists(options.save_map, ignored)) {
    throw tools::Failure(tools::kExitUsage,
                         options.save_map + ": exists; give --force to overwrite it");
  }
  try {
    mapfile::check_writable(options.save_map);
  } catch (const mapfile::Error& error) {
    throw failure(error);
  }
}

void check_size(const Options& options, const mapfile::About& about) {
  const auto size = frame_size(options);
  if (!size || (size->width == about.image_width && size->height == about.image_height)) return;
  throw tools::Failure(tools::kExitInput,
                       options.load_map + ": the map's images have " +
                           drivers::size_text(about.image_width, about.image_height) +
                           " pixels, those of " + options.sequence + " " +
                           drivers::size_text(size->width, size->height) +
                           "; give images of the map's size and camera, or make a map of these");
}

}  // namespace

std::optional<mapfile::MapFile> open_map(const Options& options) {
  if (!options.save_map.empty()) check_saving(options);
  if (options.load_map.empty()) return std::nullopt;
  try {
    std::optional<mapfile::MapFile> map(std::in_place, options.load_map);
    check_size(options, map->about());
    return map;
  } catch (const mapfile::Error& error) {
    throw failure(error);
  }
}

void hand_over(mapfile::MapFile* map, pipeline::Pipeline* pipeline) {
  try {
    pipeline->load(map);
  } catch (const mapfile::Error& error) {
    throw failure(error);
  }
}

std::string save_map(const Options& options, const pipeline::Pipeline& pipeline,
                     unisim_predictor* predictor) {
  if (options.save_map.empty()) return "";
  mapfile::About about;
  about.program = std::string(options.program) + " " + version_text();
  about.sequence = options.sequence;
  try {
    pipeline::save_map(options.save_map, about, pipeline, predictor);
    return "";
  } catch (const mapfile::Error& error) {
    return error.what();
  }
}

}  // namespace unisim::replay
