// SPDX-License-Identifier: MIT
// The model or models of a predictor.
#include "drivers/onnx/model/models.hpp"

#include <algorithm>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/model/encoders.hpp"
#include "drivers/onnx/model/model_notes.hpp"
#include "drivers/predictor.h"

namespace unisim::onnx {
namespace {

constexpr int32_t kPairViews = 2;
// Windows wait for the pairs after them: a few keyframes more than a window are kept.
constexpr int32_t kSpareViews = 4;
// The tracking goes on while a window is inferred: as much further as drivers/predictor.h allows.
constexpr int32_t kSpareWindowViews = kSpareViews + UNISIM_WINDOW_LAG;

void require_kind(const Model& model, bool fits, const char* role, const char* wanted) {
  if (fits) return;
  throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                  model.path() + ": its kind cannot predict " + role + "; give " + wanted);
}

void load_roles(const Config& config, const std::shared_ptr<const Runtime>& runtime,
                Models* models) {
  models->pair = std::make_shared<Model>(runtime, config.model_pair, config.run);
  require_kind(*models->pair, models->pair->contract().kind != Kind::kDescriptor, "pairs",
               "a model of kind pair or multiview");
  models->window = config.model_window == config.model_pair
                       ? models->pair->another_lane()
                       : std::make_unique<Model>(runtime, config.model_window, config.run);
  require_kind(*models->window, models->window->contract().kind == Kind::kMultiview, "windows",
               "a model of kind multiview, by itself or besides the one for pairs");
}

/// Suits the size of windows to the budget, which also holds the keyframes kept for them.
void warm_up(const Config& config, bool views_shared, Models* models) {
  MemoryBudget budget;
  budget.bytes = config.run.memory_bytes;
  if (!views_shared) budget.kept_bytes = kSpareViews * models->pair->view_bytes();
  for (const auto& encoder : models->encoders) encoder->warm_up(budget);
  models->pair->warm_up(kPairViews, kPairViews, budget);
  // A pair may be inferred while a window is.
  budget.kept_bytes += models->pair->costs().front().bytes;
  budget.kept_bytes += kSpareWindowViews * models->window->view_bytes();
  budget.kept_bytes_per_view = models->window->view_bytes();
  models->window->warm_up(kPairViews, config.window_size, budget);
  models->window_size = std::min(config.window_size, models->window->max_views());
}

std::shared_ptr<Views> make_views(const Model& model, const std::shared_ptr<Encoder>& encoder,
                                  int32_t capacity) {
  return std::make_shared<Views>(model.contract(), encoder, model.view_floats(), capacity);
}

void tell(const Config& config, const Runtime& runtime, Models* models) {
  std::vector<std::string>& notes = models->notes;
  notes.push_back(runtime.name());
  const auto tell_model = [&](const Model& model) {
    notes.push_back(licence_line(model.contract()));
    notes.push_back(cost_line(model.contract(), "", model.costs()));
  };
  tell_model(models->window->same_network(*models->pair) ? *models->window : *models->pair);
  if (!models->window->same_network(*models->pair)) tell_model(*models->window);
  for (const auto& encoder : models->encoders) {
    notes.push_back(cost_line(encoder->contract(), " encoder", {encoder->cost()}));
  }
  notes.push_back(ring_line(*models->window_views));
  if (models->pair_views != models->window_views) notes.push_back(ring_line(*models->pair_views));
  const std::string reduced =
      reduction_line(*models->window, config.window_size, config.run.memory_bytes);
  if (!reduced.empty()) notes.push_back(reduced);
}

}  // namespace

int64_t Models::bytes() const {
  int64_t sum = pair->bytes() + window->bytes() + window_views->bytes();
  if (pair_views != window_views) sum += pair_views->bytes();
  for (const auto& encoder : encoders) sum += encoder->bytes();
  return sum;
}

Models load_models(const Config& config) {
  const auto runtime = Runtime::open(config.run.library);
  Models models;
  load_roles(config, runtime, &models);
  Encoders encoders(runtime, config.model_encoder, config.run);
  const auto pair_encoder = encoders.of(*models.pair);
  const auto window_encoder = encoders.of(*models.window);
  models.encoders = encoders.loaded();
  if (!config.model_encoder.empty() && models.encoders.empty()) {
    throw OnnxError(UNISIM_ONNX_BAD_CONFIG,
                    "onnx.model_encoder: no model takes the features of an encoder; leave it out");
  }
  const bool views_shared = models.pair->same_network(*models.window) ||
                            (pair_encoder != nullptr && pair_encoder == window_encoder);
  warm_up(config, views_shared, &models);
  models.window_views =
      make_views(*models.window, window_encoder, models.window_size + kSpareWindowViews);
  models.pair_views =
      views_shared ? models.window_views : make_views(*models.pair, pair_encoder, kSpareViews);
  tell(config, *runtime, &models);
  return models;
}

}  // namespace unisim::onnx
