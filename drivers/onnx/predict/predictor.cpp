// SPDX-License-Identifier: MIT
// Models in ONNX format behind the table of drivers/predictor.h.
#include <exception>
#include <memory>
#include <new>
#include <numeric>
#include <string>
#include <vector>

#include "drivers/common/packed_copy.hpp"
#include "drivers/common/size_text.hpp"
#include "drivers/onnx/config.hpp"
#include "drivers/onnx/creation.hpp"
#include "drivers/onnx/error.hpp"
#include "drivers/onnx/model/models.hpp"
#include "drivers/onnx/onnx.h"
#include "drivers/onnx/predict/place_describer.hpp"
#include "drivers/onnx/predict/place_images.hpp"
#include "drivers/onnx/predict/refused_pairs.hpp"
#include "drivers/onnx/predict/role.hpp"
#include "drivers/onnx/predict/window_role.hpp"
#include "drivers/onnx/runtime/memory_use.hpp"

namespace unisim::onnx {
namespace {

// Of the lengths of models that say metres, relative: of one window, and what a camera and a kind
// of scene make wrong in all of them. From the 5-10 % that such models publish on scenes they have
// not seen; none has been measured here.
constexpr double kMetricSigma = 0.1;
constexpr double kMetricCommonSigma = 0.05;

// Runs that fail one after another mean that the device is gone, not that one input was bad.
constexpr int32_t kMaxFailures = 3;

/// What one group of functions changes: the groups run beside each other.
struct Lane {
  int32_t failures = 0;  // of predictions, in a row
  double focal_px = 0;
  std::string message;
};

struct OnnxPredictor {
  unisim_predictor table{};  // first: the table's address is the predictor's
  Config config;
  Models models;
  std::unique_ptr<Role> pair;
  std::unique_ptr<RefusedPairs> refused_pairs;
  std::unique_ptr<WindowRole> window;
  std::unique_ptr<PlaceDescriber> describer;
  PlaceImages places;
  unisim_image shape{};         // every image's size
  unisim_image newest{};        // keyframe, for place_descriptor()
  std::vector<uint8_t> pixels;  // of it
  int64_t last_keyframe_frame = -1;
  int32_t keyframes = 0;
  int32_t encode_failures = 0;  // of keyframes, in a row
  Lane front;
  Lane back;
  int64_t windows = 0;
};

OnnxPredictor* self(unisim_predictor* predictor) {
  return reinterpret_cast<OnnxPredictor*>(predictor);
}
const OnnxPredictor* self(const unisim_predictor* predictor) {
  return reinterpret_cast<const OnnxPredictor*>(predictor);
}

/// Runs `body`; nothing thrown below crosses the C interface.
template <typename Body>
int guarded(unisim_predictor* predictor, Lane OnnxPredictor::* lane, Body&& body) {
  OnnxPredictor* me = self(predictor);
  try {
    return body(me);
  } catch (const std::bad_alloc&) {
    (me->*lane).message = "out of memory; take a model with a smaller input or smaller windows";
  } catch (const std::exception& error) {
    (me->*lane).message = error.what();
  }
  return UNISIM_PREDICTION_FAILED;
}

/// What follows from the size of the images is made with the first one.
void take_shape(OnnxPredictor* me, const unisim_image& image) {
  me->shape = image;
  me->pixels.reserve(static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  Models& models = me->models;
  models.window_views->set_image_size(image.width, image.height);
  if (models.pair_views != models.window_views) {
    models.pair_views->set_image_size(image.width, image.height);
  }
  const double least = me->config.min_pose_confidence;
  me->pair = std::make_unique<Role>(models.pair, models.pair_views, 2, least);
  me->window = std::make_unique<WindowRole>(
      std::make_unique<Role>(models.window, models.window_views, models.window_size, least),
      me->refused_pairs.get());
}

bool accept_image(OnnxPredictor* me, const unisim_image& image) {
  if (image.data == nullptr || image.width < 1 || image.height < 1) {
    me->front.message = "image is empty; frame left out";
    return false;
  }
  if (image.format != UNISIM_PIXEL_GRAY8 && image.format != UNISIM_PIXEL_BGR8) {
    me->front.message =
        "pixel format " + std::to_string(image.format) + " is neither gray nor BGR; frame left out";
    return false;
  }
  if (me->pair == nullptr) take_shape(me, image);
  if (image.width != me->shape.width || image.height != me->shape.height) {
    me->front.message = "image size changed from " +
                        drivers::size_text(me->shape.width, me->shape.height) + " to " +
                        drivers::size_text(image.width, image.height) + "; frame left out";
    return false;
  }
  return true;
}

int observe(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion) {
  *motion = {-1.0, -1.0, 0, 0};
  return guarded(predictor, &OnnxPredictor::front, [&](OnnxPredictor* me) {
    if (!accept_image(me, frame->image)) return UNISIM_PREDICTION_REJECTED;
    // A network needs no motion to see depth, and says nothing of it before it runs: a fixed beat.
    const int64_t gap = frame->index - me->last_keyframe_frame;
    const bool due = me->last_keyframe_frame < 0 || gap >= me->config.keyframe_interval;
    motion->keyframe_advice = due ? 1 : -1;
    return UNISIM_PREDICTION_OK;
  });
}

int keyframe(unisim_predictor* predictor, const unisim_frame* frame, int32_t id) {
  return guarded(predictor, &OnnxPredictor::front, [&](OnnxPredictor* me) {
    if (me->pair == nullptr || id != me->keyframes || frame->image.data == nullptr) {
      me->front.message = "keyframe " + std::to_string(id) + " came out of order or without image";
      return UNISIM_PREDICTION_FAILED;
    }
    ++me->keyframes;
    me->last_keyframe_frame = frame->index;
    me->newest = drivers::packed_copy(frame->image, &me->pixels);
    // What could not be encoded is told by the predictions that need it.
    Answer answer = me->models.window_views->add(id, frame->image);
    if (me->models.pair_views != me->models.window_views) {
      Answer other = me->models.pair_views->add(id, frame->image);
      if (other.run_failed) answer = std::move(other);
    }
    me->encode_failures = answer.run_failed ? me->encode_failures + 1 : 0;
    if (me->encode_failures < kMaxFailures) return UNISIM_PREDICTION_OK;
    me->front.message = std::move(answer.problem);
    return UNISIM_PREDICTION_FAILED;
  });
}

template <typename AnyRole>
int predict(Lane* lane, AnyRole* role, const int32_t* ids, int32_t count) {
  if (role == nullptr) return UNISIM_PREDICTION_PENDING;
  Answer answer = role->predict(ids, count);
  if (answer.problem.empty()) {
    lane->failures = 0;
    lane->focal_px = role->outputs().focal_px();
    return UNISIM_PREDICTION_OK;
  }
  lane->message = std::move(answer.problem);
  lane->failures = answer.run_failed ? lane->failures + 1 : 0;
  return lane->failures < kMaxFailures ? UNISIM_PREDICTION_REJECTED : UNISIM_PREDICTION_FAILED;
}

int two_view(unisim_predictor* predictor, int32_t i, int32_t j, unisim_pair_prediction* out) {
  return guarded(predictor, &OnnxPredictor::front, [&](OnnxPredictor* me) {
    const int32_t ids[2] = {i, j};
    const int status = predict(&me->front, me->pair.get(), ids, 2);
    if (status == UNISIM_PREDICTION_PENDING) return status;
    me->refused_pairs->settle(j, status != UNISIM_PREDICTION_OK);
    if (status != UNISIM_PREDICTION_OK) return status;
    const Outputs& outputs = me->pair->outputs();
    *out = {};
    out->T_i_j = outputs.T_0_view()[1];
    out->depth_i = outputs.maps()[0];
    out->depth_j = outputs.maps()[1];
    out->focal_px = outputs.focal_px();
    return status;
  });
}

int multi_view(unisim_predictor* predictor, const int32_t* ids, int32_t count,
               unisim_window_prediction* out) {
  return guarded(predictor, &OnnxPredictor::back, [&](OnnxPredictor* me) {
    if (count > me->models.window_size) {
      me->back.message = std::to_string(count) + " views are more than the " +
                         std::to_string(me->models.window_size) +
                         " that model and memory allow; lower session.window_size";
      return UNISIM_PREDICTION_REJECTED;
    }
    const int status = predict(&me->back, me->window.get(), ids, count);
    if (status != UNISIM_PREDICTION_OK) return status;
    const WindowRole& window = *me->window;
    *out = {window.count(),
            window.ids(),
            window.outputs().T_0_view().data(),
            window.outputs().maps().data(),
            window.outputs().focal_px(),
            0.0,
            me->windows++,
            window.remark().empty() ? nullptr : window.remark().c_str(),
            me->models.window->contract().metric ? 1.0 : 0.0,
            kMetricSigma,
            kMetricCommonSigma};
    return status;
  });
}

int place_descriptor(unisim_predictor* predictor, int32_t id, unisim_place_descriptor* out) {
  return guarded(predictor, &OnnxPredictor::front, [&](OnnxPredictor* me) {
    const int status = me->describer->describe(me->newest);
    if (status != UNISIM_PREDICTION_OK) {
      me->front.message = me->describer->message();
      return status;
    }
    me->places.add(id, me->newest);
    const std::vector<int8_t>& values = me->describer->values();
    *out = {values.data(), static_cast<int32_t>(values.size()), me->newest.width, me->newest.height,
            0};
    return status;
  });
}

void release_place(unisim_predictor* predictor, int32_t id) { self(predictor)->places.release(id); }

void info(unisim_predictor* predictor, unisim_predictor_info* out) {
  const OnnxPredictor* me = self(predictor);
  *out = {};
  out->focal_px = me->back.focal_px > 0 ? me->back.focal_px : me->front.focal_px;
  out->initialised = out->focal_px > 0 ? 1 : 0;
  out->state_bytes = me->models.bytes() + me->places.bytes();
  if (me->pair == nullptr) return;
  out->state_bytes += me->pair->outputs().bytes() + me->window->outputs().bytes();
}

/// NULL: none was named. @throws OnnxError
unisim_onnx_descriptor* open_descriptor(const unisim_onnx_config& config) {
  const char* const path = config.model_descriptor;
  if (path == nullptr || *path == '\0') return nullptr;
  int32_t problem = 0;
  char line[512] = "";
  unisim_onnx_descriptor* const model =
      unisim_onnx_descriptor_open(&config, path, &problem, line, sizeof line);
  if (model == nullptr) throw OnnxError(problem, line);
  return model;
}

const char* message(unisim_predictor* predictor) { return self(predictor)->front.message.c_str(); }

const char* window_message(unisim_predictor* predictor) {
  return self(predictor)->back.message.c_str();
}

void destroy(unisim_predictor* predictor) { delete self(predictor); }

}  // namespace
}  // namespace unisim::onnx

unisim_predictor* unisim_onnx_create(const unisim_onnx_config* config, int32_t* problem,
                                     char* message, size_t capacity) {
  namespace o = unisim::onnx;
  return o::create(problem, message, capacity, [&]() {
    auto made = std::make_unique<o::OnnxPredictor>();
    made->config = o::read_config(*config);
    made->models = o::load_models(made->config);
    made->describer = std::make_unique<o::PlaceDescriber>(o::open_descriptor(*config));
    made->models.window_views->set_places(&made->places);
    made->refused_pairs = std::make_unique<o::RefusedPairs>(made->models.window_views->capacity());
    unisim_predictor& table = made->table;
    table.struct_size = sizeof table;
    table.name = "onnx";
    table.concurrent_windows = 1;
    table.needs_images = 1;
    table.observe = o::observe;
    table.keyframe = o::keyframe;
    table.two_view = o::two_view;
    table.multi_view = o::multi_view;
    table.info = o::info;
    table.message = o::message;
    table.window_message = o::window_message;
    table.destroy = o::destroy;
    table.place_descriptor = o::place_descriptor;
    table.release_place = o::release_place;
    return &made.release()->table;
  });
}

int32_t unisim_onnx_window_size(const unisim_predictor* predictor) {
  return unisim::onnx::self(predictor)->models.window_size;
}

const char* unisim_onnx_note(const unisim_predictor* predictor, int32_t index) {
  const auto& notes = unisim::onnx::self(predictor)->models.notes;
  const auto at = static_cast<size_t>(index);
  return index >= 0 && at < notes.size() ? notes[at].c_str() : nullptr;
}

int64_t unisim_onnx_encoder_runs(const unisim_predictor* predictor) {
  const auto& encoders = unisim::onnx::self(predictor)->models.encoders;
  return std::accumulate(encoders.begin(), encoders.end(), int64_t{0},
                         [](int64_t sum, const auto& encoder) { return sum + encoder->runs(); });
}

int64_t unisim_onnx_peak_before_bytes() { return unisim::onnx::peak_before_reset_bytes(); }
