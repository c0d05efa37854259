// SPDX-License-Identifier: MIT
// Opens what a run works with.
#include "tools/replay/inputs.hpp"

#include <filesystem>

#include "drivers/geometric/geometric.h"
#include "drivers/onnx/onnx.h"
#include "drivers/recorded/recorded.h"
#include "drivers/sequence/sequence.h"
#include "tools/common/failure.hpp"
#include "tools/replay/mask.hpp"
#include "tools/replay/window_layout.hpp"

namespace unisim::replay {
namespace {

constexpr size_t kLine = 1024;

int exit_code(int32_t onnx_problem) {
  switch (onnx_problem) {
    case UNISIM_ONNX_BAD_MODEL:
      return tools::kExitInput;
    case UNISIM_ONNX_NO_RUNTIME:
    case UNISIM_ONNX_NO_MEMORY:
      return tools::kExitLimit;
    default:
      return tools::kExitUsage;
  }
}

PredictorPtr open_onnx(const Options& options, std::vector<std::string>* notes) {
  unisim_onnx_config config = options.settings.onnx;
  config.window_size = options.settings.session.window_size;
  config.model_pair = options.model_pair.c_str();
  config.model_window = options.model_window.c_str();
  config.model_encoder = options.model_encoder.c_str();
  config.model_descriptor = options.model_descriptor.c_str();
  config.provider = options.provider.c_str();
  config.library = options.onnx_runtime.c_str();
  char message[kLine] = "";
  int32_t problem = UNISIM_ONNX_OK;
  PredictorPtr predictor(unisim_onnx_create(&config, &problem, message, sizeof message));
  if (predictor == nullptr) throw tools::Failure(exit_code(problem), message);
  for (int32_t i = 0; unisim_onnx_note(predictor.get(), i) != nullptr; ++i) {
    notes->emplace_back(unisim_onnx_note(predictor.get(), i));
  }
  return predictor;
}

/// Before the run rather than at its first frame: a wrong file is bad input.
void check_camera(const Options& options) {
  const unisim_geometric_config& camera = options.settings.geometric;
  if (camera.calibrated_width == 0 && camera.principal_x_px == 0) return;
  const auto size = frame_size(options);
  char message[kLine] = "";
  if (!size || unisim_geometric_camera_fits(&camera, size->width, size->height, message,
                                            sizeof message) != 0) {
    return;
  }
  throw tools::Failure(tools::kExitInput, options.sequence + ": " + message);
}

PredictorPtr open_inner(const Options& options, std::vector<std::string>* notes) {
  if (options.predictor == "onnx") return open_onnx(options, notes);
  char message[kLine] = "";
  if (options.predictor == "recorded") {
    PredictorPtr predictor(
        unisim_recorded_open(options.predictions.c_str(), message, sizeof message));
    if (predictor == nullptr) throw tools::Failure(tools::kExitInput, message);
    notes->emplace_back(message);
    return predictor;
  }
  check_camera(options);
  const Mask mask = load_mask(options);
  unisim_geometric_config config = options.settings.geometric;
  config.mask = mask.view;
  PredictorPtr predictor(unisim_geometric_create(&config, message, sizeof message));
  if (predictor == nullptr) throw tools::Failure(tools::kExitUsage, message);
  return predictor;
}

}  // namespace

SourcePtr open_sequence(const Options& options, std::vector<std::string>* notes) {
  unisim_sequence_options wanted{};
  wanted.struct_size = sizeof wanted;
  wanted.format = options.format.c_str();
  wanted.from = options.from;
  wanted.to = options.to;
  wanted.channel = options.lcm_image_channel.c_str();
  char message[kLine] = "";
  SourcePtr source(
      unisim_sequence_open(options.sequence.c_str(), &wanted, message, sizeof message));
  if (source == nullptr) throw tools::Failure(tools::kExitInput, message);
  for (int32_t i = 0; unisim_sequence_note(source.get(), i) != nullptr; ++i) {
    notes->emplace_back(unisim_sequence_note(source.get(), i));
  }
  return source;
}

std::optional<FrameSize> frame_size(const Options& options) {
  if (options.settings.pipeline.live) return options.live_size;
  std::vector<std::string> notes;
  const SourcePtr source = open_sequence(options, &notes);
  unisim_frame frame{};
  int answer = UNISIM_FRAME_BAD;
  while (answer == UNISIM_FRAME_BAD) answer = source->next_frame(source.get(), 1, &frame);
  if (answer != UNISIM_FRAME_OK) return std::nullopt;
  return FrameSize{frame.image.width, frame.image.height};
}

PredictorPtr open_predictor(const Options& options, Settings* settings,
                            std::vector<std::string>* notes) {
  PredictorPtr inner = open_inner(options, notes);
  fit_windows(options.predictor, inner.get(), settings);
  if (options.record.empty()) return inner;
  std::error_code ignored;
  if (!options.force && std::filesystem::is_regular_file(options.record, ignored)) {
    throw tools::Failure(tools::kExitUsage,
                         options.record + ": exists; give --force to overwrite it");
  }
  char message[kLine] = "";
  // The recorder owns the predictor from here on; where it cannot be made, it is still ours.
  unisim_predictor* const given = inner.release();
  PredictorPtr recorder(unisim_recorder_create(given, options.record.c_str(),
                                               options.sequence.c_str(), message, sizeof message));
  if (recorder == nullptr) {
    inner.reset(given);
    throw tools::Failure(tools::kExitInput, message);
  }
  return recorder;
}

std::string recorder_problem(const Options& options, const unisim_predictor* predictor) {
  return options.record.empty() ? "" : unisim_recorder_problem(predictor);
}

}  // namespace unisim::replay
