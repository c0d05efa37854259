// SPDX-License-Identifier: MIT
// The camera of depth images, as recordings spell it.
#include "tools/eval/depth_camera.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "drivers/sequence/folder.hpp"

namespace unisim::eval {
namespace {

constexpr DepthCamera kSevenScenes = {585.0, 585.0, 320.0, 240.0, 0.0};

bool possible(const DepthCamera& camera) {
  const double sum = camera.fx + camera.fy + camera.cx + camera.cy + camera.k1;
  return std::isfinite(sum) && camera.fx > 0.0 && camera.fy > 0.0;
}

// "name = number" lines, which is all that camera.toml needs.
bool read_toml(const std::string& path, DepthCamera* camera) {
  const std::map<std::string, double*, std::less<>> fields = {{"fx", &camera->fx},
                                                              {"fy", &camera->fy},
                                                              {"cx", &camera->cx},
                                                              {"cy", &camera->cy},
                                                              {"k1", &camera->k1}};
  for (const sequence::TextLine& line : sequence::read_lines(path)) {
    const auto words = sequence::split_fields(line.text);
    const auto field = words.empty() ? fields.end() : fields.find(words[0]);
    if (field == fields.end() || words.size() < 3) continue;
    if (!sequence::parse_number(words[2], field->second)) return false;
  }
  return possible(*camera);
}

bool read_json(const std::string& path, DepthCamera* camera, double* units_per_metre) {
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object()) return false;
  const auto& inner = json.contains("camera") ? json["camera"] : json;
  const auto number = [&](const char* name) {
    return inner.is_object() && inner.contains(name) && inner[name].is_number()
               ? inner[name].get<double>()
               : std::nan("");
  };
  *camera = {number("fx"), number("fy"), number("cx"), number("cy"), 0.0};
  if (number("scale") > 0.0) *units_per_metre = number("scale");
  return possible(*camera);
}

bool read_matrix(const std::string& path, DepthCamera* camera) {
  std::vector<double> numbers;
  for (const sequence::TextLine& line : sequence::read_lines(path)) {
    for (const std::string_view field : sequence::split_fields(line.text, true)) {
      double number = 0.0;
      if (!sequence::parse_number(field, &number)) return false;
      numbers.push_back(number);
    }
  }
  if (numbers.size() != 9) return false;
  *camera = {numbers[0], numbers[4], numbers[2], numbers[5], 0.0};
  return possible(*camera);
}

bool read_camera(const std::string& path, const std::string& name, DepthImages* found) {
  if (name == "camera.toml") return read_toml(path, &found->camera);
  if (name == "cam_params.json") return read_json(path, &found->camera, &found->units_per_metre);
  return read_matrix(path, &found->camera);
}

bool is_camera_file(const std::string& name) {
  const bool matrix = name.find("intrinsics") != std::string::npos && name.size() > 4 &&
                      name.compare(name.size() - 4, 4, ".txt") == 0;
  return matrix || name == "camera.toml" || name == "cam_params.json";
}

}  // namespace

void find_depth_camera(const std::string& folder, DepthImages* found) {
  // With ".." a folder given as "." has one above it too.
  for (const std::string& place : {folder, sequence::join(folder, "..")}) {
    for (const std::string& name : sequence::list_folder(place)) {
      if (!is_camera_file(name)) continue;
      found->camera_from = sequence::join(place, name);
      if (read_camera(found->camera_from, name, found)) return;
      throw InputError(found->camera_from +
                       ": no camera in it: give the depth camera with --intrinsics fx,fy,cx,cy");
    }
  }
  if (found->format != "7scenes") {
    throw InputError(folder +
                     ": its depth camera is not known: give it with --intrinsics fx,fy,cx,cy");
  }
  found->camera = kSevenScenes;
  found->camera_from = "usual for 7-Scenes";
}

}  // namespace unisim::eval
