// SPDX-License-Identifier: MIT
// The map of a run as a file.
#include "drivers/pipeline/map_saving.hpp"

#include <utility>

namespace unisim::pipeline {

void save_map(const std::string& path, mapfile::About about, const Pipeline& pipeline,
              unisim_predictor* predictor) {
  const auto refuse = [&](const char* why) {
    throw mapfile::Error(mapfile::Error::Kind::kInput, path + ": no map is saved: " + why);
  };
  const Result& result = pipeline.result();
  if (result.outcome == Outcome::kPredictorFailed || result.outcome == Outcome::kSessionFailed) {
    refuse("the run has failed");
  }
  unisim_session_info info{};
  info.struct_size = sizeof info;
  if (unisim_get_info(pipeline.session(), &info) != UNISIM_OK ||
      info.posed_keyframes <= pipeline.before().posed_keyframes) {
    refuse("no keyframe of this run has a pose");
  }
  about.image_width = result.image_width;
  about.image_height = result.image_height;
  mapfile::save_map(path, std::move(about), pipeline.session(), predictor, pipeline.retired(),
                    pipeline.windows());
}

}  // namespace unisim::pipeline
