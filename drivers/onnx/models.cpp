// SPDX-License-Identifier: MIT
// The model or models of a predictor.
#include "drivers/onnx/models.hpp"

#include <algorithm>
#include <cstdio>

#include "drivers/onnx/error.hpp"

namespace unisim::onnx {
namespace {

constexpr int32_t kPairViews = 2;

void require_kind(const Model& model, bool fits, const char* role, const char* wanted) {
  if (fits) return;
  throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                  model.path() + ": its kind cannot predict " + role + "; give " + wanted);
}

std::string licence_line(const Model& model) {
  const Contract& contract = model.contract();
  return contract.model + ", " + std::to_string(contract.width) + "x" +
         std::to_string(contract.height) + ", licence: " + contract.license;
}

std::string cost_line(const Model& model) {
  std::string line = model.contract().model + ":";
  for (const Cost& cost : model.costs()) {
    char text[96];
    std::snprintf(text, sizeof text, "%s %d views %.3g s and %.0f MB",
                  line.back() == ':' ? "" : ",", static_cast<int>(cost.views), cost.seconds,
                  static_cast<double>(cost.bytes) / (1 << 20));
    line += text;
  }
  return line + " at the first run";
}

/// Why windows are smaller than asked for, "" when they are not.
std::string reduction_line(const Model& model, int32_t wanted, int64_t memory_bytes) {
  const int32_t views = model.max_views();
  if (views >= wanted) return "";
  const bool by_model = model.contract().max_views < wanted && views == model.contract().max_views;
  const std::string why =
      by_model ? "the model takes no more views"
               : "more would not fit " + std::to_string(memory_bytes >> 20) + " MB of memory";
  return "windows have " + std::to_string(views) + " keyframes in place of " +
         std::to_string(wanted) + ": " + why;
}

void tell(const Model& model, std::vector<std::string>* notes) {
  notes->push_back(licence_line(model));
  notes->push_back(cost_line(model));
}

}  // namespace

Models load_models(const Config& config) {
  const auto runtime = Runtime::open(config.run.library);
  Models models;
  models.pair = std::make_shared<Model>(runtime, config.model_pair, config.run);
  require_kind(*models.pair, models.pair->contract().kind != Kind::kDescriptor, "pairs",
               "a model of kind pair or multiview");
  const bool shared = config.model_window == config.model_pair;
  models.window =
      shared ? models.pair : std::make_shared<Model>(runtime, config.model_window, config.run);
  require_kind(*models.window, models.window->contract().kind == Kind::kMultiview, "windows",
               "a model of kind multiview, by itself or besides the one for pairs");
  if (!shared) models.pair->warm_up(kPairViews, kPairViews, config.run.memory_bytes);
  models.window->warm_up(kPairViews, config.window_size, config.run.memory_bytes);
  models.window_size = std::min(config.window_size, models.window->max_views());
  models.notes.push_back(runtime->name());
  tell(*models.pair, &models.notes);
  if (!shared) tell(*models.window, &models.notes);
  const std::string reduced =
      reduction_line(*models.window, config.window_size, config.run.memory_bytes);
  if (!reduced.empty()) models.notes.push_back(reduced);
  return models;
}

}  // namespace unisim::onnx
