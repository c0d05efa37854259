// SPDX-License-Identifier: MIT
// What unisim-eval prints: the protocol, then the figures, as text or JSON.
#include "tools/eval/print.hpp"

#include "drivers/common/format.hpp"

namespace unisim::eval {
namespace {

void add_statistics(const Statistics& s, Json* out) {
  (*out)["rmse"] = s.rmse;
  (*out)["mean"] = s.mean;
  (*out)["median"] = s.median;
  (*out)["std"] = s.std;
  (*out)["min"] = s.min;
  (*out)["max"] = s.max;
  (*out)["sse"] = s.sse;
}

Json statistics_json(const Statistics& s, const char* unit) {
  Json out = {{"unit", unit}};
  add_statistics(s, &out);
  return out;
}

Json side_json(const Trajectory& trajectory) {
  return {{"file", trajectory.name},
          {"format", trajectory.format},
          {"poses", trajectory.poses.size()},
          {"skipped_lines", trajectory.skipped}};
}

Json protocol_json(const Protocol& protocol, size_t associated) {
  return {{"ground_truth", side_json(protocol.ground_truth)},
          {"estimate", side_json(protocol.estimate)},
          {"alignment", alignment_name(protocol.alignment)},
          {"max_dt_s", protocol.max_dt_s},
          {"associated_by", association_name(protocol.ground_truth, protocol.estimate)},
          {"associated", associated}};
}

Json similarity_json(const Similarity& T) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({T.R(i, 0), T.R(i, 1), T.R(i, 2)});
  return {{"rotation", rows}, {"translation", {T.t.x(), T.t.y(), T.t.z()}}, {"scale", T.s}};
}

bool is_figure(const Json& value) { return value.is_number_float(); }

// "name value" lines; objects with figures of their own get their name in front.
void add_figures(const Json& object, const std::string& prefix, std::string* out) {
  const std::string unit = object.value("unit", "");
  for (const auto& [name, value] : object.items()) {
    const std::string label = prefix + name;
    const bool has_unit = !unit.empty() && name != "scale" && name != "sse";
    if (is_figure(value)) {
      *out += drivers::format("%-20s %.9f%s%s\n", label.c_str(), value.get<double>(),
                              has_unit ? " " : "", has_unit ? unit.c_str() : "");
    } else if (value.is_object() && (value.contains("rmse") || value.contains("median"))) {
      add_figures(value, label + " ", out);
    }
  }
}

void add_side(const char* label, const Json& side, std::string* out) {
  if (!side.contains("format")) {
    *out += drivers::format("%-20s %s (%zu points, %zu not finite)\n", label,
                            side["file"].get<std::string>().c_str(), side["points"].get<size_t>(),
                            side["skipped_points"].get<size_t>());
    return;
  }
  *out += drivers::format("%-20s %s (%s, %zu poses, %zu lines skipped)\n", label,
                          side["file"].get<std::string>().c_str(),
                          side["format"].get<std::string>().c_str(), side["poses"].get<size_t>(),
                          side["skipped_lines"].get<size_t>());
}

}  // namespace

Json ate_json(const Protocol& protocol, const Ate& ate) {
  Json out = {
      {"schema", 1}, {"metric", "ate"}, {"protocol", protocol_json(protocol, ate.pairs.size())}};
  out["unit"] = "m";
  add_statistics(ate.error, &out);
  out["scale"] = ate.T_truth_estimate.s;
  out["T_truth_estimate"] = similarity_json(ate.T_truth_estimate);
  return out;
}

Json rpe_json(const Protocol& protocol, const RpeStep& step, const Rpe& rpe) {
  Json out = {
      {"schema", 1}, {"metric", "rpe"}, {"protocol", protocol_json(protocol, rpe.associated)}};
  out["protocol"]["delta"] = step.delta;
  out["protocol"]["delta_unit"] = step_unit_name(step.unit);
  out["protocol"]["steps"] = step.all_pairs ? "all" : "consecutive";
  out["pairs"] = rpe.time_s.size();
  out["translation"] = statistics_json(rpe.translation, "m");
  out["rotation"] = statistics_json(rpe.rotation_deg, "deg");
  out["scale"] = rpe.T_truth_estimate.s;
  return out;
}

Json consistency_json(const Protocol& protocol, const Consistency& found) {
  const auto ratios = [](const Ratios& r) -> Json {
    return {{"poses", r.count},
            {"beyond_3_sigma", r.beyond_3},
            {"median", r.median},
            {"p95", r.p95},
            {"max", r.max}};
  };
  size_t compared = 0;
  for (const auto& [confidence, errors] : found.by_confidence) compared += errors.count;
  Json out = {
      {"schema", 1}, {"metric", "consistency"}, {"protocol", protocol_json(protocol, compared)}};
  out["protocol"]["segments"] = found.segments;
  out["protocol"]["segments_skipped"] = found.segments_skipped;
  out["protocol"]["ratio"] = "error over the standard deviation of the run, both after alignment";
  out["protocol"]["far_off"] = "more than 10 times the median error of the segment";
  out["position"] = ratios(found.position);
  out["rotation"] = ratios(found.rotation);
  out["without_sigma"] = found.without_sigma;
  out["good"] = found.good;
  out["good_far_off"] = found.good_far_off;
  for (const auto& [confidence, errors] : found.by_confidence) {
    out["confidence_" + std::to_string(confidence)] = {
        {"poses", errors.count}, {"unit", "m"}, {"median", errors.median}};
  }
  return out;
}

Json cloud_json(const CloudProtocol& protocol, const CloudMetrics& metrics) {
  const auto side = [](const Cloud& cloud) -> Json {
    return {
        {"file", cloud.name}, {"points", cloud.points.size()}, {"skipped_points", cloud.skipped}};
  };
  Json out = {{"schema", 1}, {"metric", "cloud"}};
  out["protocol"] = {{"ground_truth", side(protocol.ground_truth)},
                     {"estimate", side(protocol.estimate)},
                     {"T_truth_estimate", similarity_json(protocol.T_truth_estimate)},
                     {"distance", "nearest neighbour, root mean square; chamfer: mean of the two"},
                     {"voxel", protocol.voxel},
                     {"max_distance", protocol.max_distance},
                     {"beyond_max_distance", metrics.beyond}};
  out["unit"] = "m";
  out["accuracy"] = metrics.accuracy.rmse;
  out["completeness"] = metrics.completeness.rmse;
  out["chamfer"] = metrics.chamfer;
  out["accuracy_detail"] = statistics_json(metrics.accuracy, "m");
  out["completeness_detail"] = statistics_json(metrics.completeness, "m");
  return out;
}

Json truth_json(const DepthImages& found, const TruthOptions& options, const TruthCloud& truth) {
  const DepthCamera& camera = found.camera;
  return {{"format", found.format},
          {"poses", found.truth.name},
          {"camera", found.camera_from},
          {"intrinsics", {camera.fx, camera.fy, camera.cx, camera.cy}},
          {"k1", camera.k1},
          {"units_per_metre", found.units_per_metre},
          {"depth_images", truth.images},
          {"depth_images_unposed", truth.unposed},
          {"depth_images_unreadable", truth.unreadable},
          {"every", options.every},
          {"pixel_step", options.pixel_step},
          {"max_depth", options.max_depth}};
}

std::string text_of(const Json& result) {
  std::string out;
  const Json& protocol = result["protocol"];
  out += drivers::format("%-20s %s\n", "metric", result["metric"].get<std::string>().c_str());
  add_side("ground truth", protocol["ground_truth"], &out);
  add_side("estimate", protocol["estimate"], &out);
  Json lines = protocol.value("truth", Json::object());
  lines.update(protocol);
  for (const auto& [name, value] : lines.items()) {
    if (value.is_object()) continue;
    out += drivers::format(
        "%-20s %s\n", name.c_str(),
        value.is_string() ? value.get<std::string>().c_str() : tools::json_text(value).c_str());
  }
  for (const char* count : {"pairs", "without_sigma", "good", "good_far_off"}) {
    if (!result.contains(count)) continue;
    out += drivers::format("%-20s %zu\n", count, result[count].get<size_t>());
  }
  add_figures(result, "", &out);
  return out;
}

}  // namespace unisim::eval
