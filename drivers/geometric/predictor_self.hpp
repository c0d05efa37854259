// SPDX-License-Identifier: MIT
// What stands behind the table of a geometric predictor.
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/geometric/camera/ideal_view.hpp"
#include "drivers/geometric/geometric.h"
#include "drivers/geometric/map/mapper.hpp"
#include "drivers/geometric/predict/predictions.hpp"
#include "drivers/predictor.h"

namespace unisim::geometric {

struct GeometricPredictor {
  unisim_predictor table{};  // first: the table's address is the predictor's
  unisim_geometric_config config{};
  unisim_geometric_config given{};  // what was said of the camera; `config` has it as it is used
  bool loaded = false;              // the map is a saved one
  std::vector<uint8_t> mask;        // pixels of config.mask
  IdealView view;
  std::unique_ptr<Mapper> mapper;
  std::unique_ptr<Predictions> predictions;
  cv::Size size;
  int32_t keyframes = 0;
  int32_t static_frames = 0;
  int64_t left_out = 0;  // frames that could not be taken
  PlaceFound located;
  std::string message;
  std::string left_out_why;
  std::string no_start;                  // what info() says of a run without a start
  std::vector<unisim_feature> features;  // of features()
};

inline GeometricPredictor* self(unisim_predictor* predictor) {
  return reinterpret_cast<GeometricPredictor*>(predictor);
}

/// Runs `body`; nothing thrown below crosses the C interface.
template <typename Body>
int guarded(unisim_predictor* predictor, Body&& body) {
  GeometricPredictor* me = self(predictor);
  try {
    return body(me);
  } catch (const std::bad_alloc&) {
    me->message = "geometric: out of memory; lower max_keyframes or max_landmarks";
  } catch (const std::exception& error) {
    me->message = std::string("geometric: ") + error.what();
  }
  return UNISIM_PREDICTION_FAILED;
}

/// @return false with a message for an unusable image
bool accept_image(GeometricPredictor* me, const unisim_image& image);

/// Fills the part of the table that is about maps.
void fill_map_calls(unisim_predictor* table);

}  // namespace unisim::geometric
