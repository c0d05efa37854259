// SPDX-License-Identifier: MIT
// The geometric predictor behind the table of drivers/predictor.h.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "drivers/common/size_text.hpp"
#include "drivers/geometric/config.hpp"
#include "drivers/geometric/predictor_self.hpp"
#include "drivers/geometric/start/start_report.hpp"

namespace unisim::geometric {
namespace {

constexpr double kStaticFlow = 0.0008;  // of the diagonal: less is a camera at rest
constexpr double kStaticKept = 0.8;     // share of tracks that must agree
constexpr double kUrgentKept = 0.4;     // share of tracks below which a keyframe is needed
constexpr int32_t kMinSide = 64;        // pixels

/// A mask of another size than the first image's ends the run: no frame would be looked at rightly.
bool fits_mask(GeometricPredictor* me, const unisim_image& image) {
  const unisim_image& mask = me->config.mask;
  if (me->mapper || mask.data == nullptr || image.data == nullptr) return true;
  if (mask.width == image.width && mask.height == image.height) return true;
  me->message = "the mask has " + drivers::size_text(mask.width, mask.height) +
                " pixels, the images " + drivers::size_text(image.width, image.height) +
                "; give a mask of the images' size";
  return false;
}

/// Makes the state for the first image. @return false with a message when the camera is another
bool open_state(GeometricPredictor* me, const cv::Size& size) {
  if (me->mapper) return true;
  me->message = me->view.open(size, &me->config);
  if (!me->message.empty()) return false;
  me->size = size;
  me->mapper = std::make_unique<Mapper>(me->config, size);
  me->predictions = std::make_unique<Predictions>(me->config, size);
  return true;
}

}  // namespace

bool accept_image(GeometricPredictor* me, const unisim_image& image) {
  if (image.data == nullptr) {
    me->message = "geometric: the frame has no pixels";
    return false;
  }
  if (image.width < kMinSide || image.height < kMinSide) {
    me->message = "geometric: " + drivers::size_text(image.width, image.height) +
                  " pixels are too few; give images of at least " +
                  drivers::size_text(kMinSide, kMinSide);
    return false;
  }
  if (image.format != UNISIM_PIXEL_GRAY8 && image.format != UNISIM_PIXEL_BGR8) {
    me->message =
        "geometric: pixel format " + std::to_string(image.format) + " is neither gray nor BGR";
    return false;
  }
  const cv::Size size(image.width, image.height);
  if (me->mapper && size != me->size && me->loaded) {
    me->message = "geometric: the map's images have " +
                  drivers::size_text(me->size.width, me->size.height) + " pixels, these " +
                  drivers::size_text(size.width, size.height) + "; give frames of the map's size";
    return false;
  }
  if (me->mapper && size != me->size) {
    me->message = "geometric: image size changed from " +
                  drivers::size_text(me->size.width, me->size.height) + " to " +
                  drivers::size_text(size.width, size.height);
    return false;
  }
  return true;
}

namespace {

/// What is wrong with the newest frame; where nothing is and there is no map yet, what is missing.
int32_t reason_now(const Mapper& mapper) {
  const int32_t reason = mapper.frame_reason();
  if (reason != UNISIM_REASON_NONE || mapper.counts().started > 0) return reason;
  return start_reason(mapper.start_statistics().newest);
}

int observe(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion) {
  *motion = {-1.0, -1.0, 0, 0};
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!fits_mask(me, frame->image)) return UNISIM_PREDICTION_FAILED;
    if (!accept_image(me, frame->image)) {
      ++me->left_out;
      me->left_out_why = me->message;
      return UNISIM_PREDICTION_REJECTED;
    }
    if (!open_state(me, {frame->image.width, frame->image.height})) return UNISIM_PREDICTION_FAILED;
    unisim_frame seen = *frame;
    if (me->view.active()) seen.image = me->view.run(frame->image, true);
    me->mapper->see(seen);
    const TrackMotion moved = me->mapper->motion();
    motion->tracked = moved.kept;
    motion->reason = reason_now(*me->mapper);
    if (moved.displacement_px < 0) return UNISIM_PREDICTION_OK;
    motion->flow = moved.displacement_px / std::hypot(me->size.width, me->size.height);
    if (motion->flow < kStaticFlow && moved.kept > kStaticKept) ++me->static_frames;
    if (moved.kept < kUrgentKept || me->mapper->loses_much()) motion->keyframe_advice = 1;
    return UNISIM_PREDICTION_OK;
  });
}

int keyframe(unisim_predictor* predictor, const unisim_frame*, int32_t id) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper || id != me->keyframes) {
      me->message = "geometric: keyframe " + std::to_string(id) + " came out of order";
      return UNISIM_PREDICTION_FAILED;
    }
    ++me->keyframes;
    if (me->mapper->add_keyframe(id)) {
      me->predictions->state_adjusted();
    } else {
      me->predictions->state_grew();
    }
    return UNISIM_PREDICTION_OK;
  });
}

int two_view(unisim_predictor* predictor, int32_t i, int32_t j, unisim_pair_prediction* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper) return UNISIM_PREDICTION_PENDING;
    const char* why = "";
    const int status = me->predictions->pair(*me->mapper, i, j, out, &why);
    if (status != UNISIM_PREDICTION_OK) me->message = why;
    return status;
  });
}

int multi_view(unisim_predictor* predictor, const int32_t* ids, int32_t count,
               unisim_window_prediction* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper) return UNISIM_PREDICTION_PENDING;
    const char* why = "";
    const int status = me->predictions->window(me->mapper.get(), ids, count, out, &why);
    if (status != UNISIM_PREDICTION_OK) me->message = why;
    return status;
  });
}

int next_revision(unisim_predictor* predictor, unisim_window_revision* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper) return UNISIM_PREDICTION_PENDING;
    me->mapper->keep_place();
    return me->predictions->revision(*me->mapper, out);
  });
}

int next_wide_window(unisim_predictor* predictor, int32_t max_views,
                     unisim_window_prediction* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper) return UNISIM_PREDICTION_PENDING;
    return me->predictions->wide_window(*me->mapper, max_views, out);
  });
}

int frame_pose(unisim_predictor* predictor, unisim_frame_pose* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper || !me->mapper->state().initialised) return UNISIM_PREDICTION_PENDING;
    const LandmarkMap& map = me->mapper->state().map;
    const Keyframe& newest = map.keyframe(map.end_id() - 1);
    const FramePose found = me->mapper->frame_pose();
    if (!found.good || !newest.posed) {
      me->message = "geometric: frame has too few known landmarks in sight";
      return UNISIM_PREDICTION_REJECTED;
    }
    out->T_kf_frame = relative_sim3(newest.pose, found.pose);
    out->keyframe_id = newest.id;
    return UNISIM_PREDICTION_OK;
  });
}

int32_t features(unisim_predictor* predictor, const unisim_feature** out) {
  const int status = guarded(predictor, [&](GeometricPredictor* me) {
    me->features.clear();
    if (!me->mapper) return UNISIM_PREDICTION_OK;
    const Tracks& tracks = me->mapper->state().tracks;
    const LandmarkMap& map = me->mapper->state().map;
    for (size_t i = 0; i < tracks.size(); ++i) {
      const bool placed = map.landmark(tracks.landmark[i]).state == LandmarkState::kPlaced;
      const cv::Point2f place = me->view.place_in_image(tracks.point[i]);
      me->features.push_back({place.x, place.y, placed ? 1 : 0});
    }
    return UNISIM_PREDICTION_OK;
  });
  *out = self(predictor)->features.data();
  return status == UNISIM_PREDICTION_OK ? static_cast<int32_t>(self(predictor)->features.size())
                                        : 0;
}

int finish(unisim_predictor* predictor) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (me->mapper && me->mapper->finish()) me->predictions->state_adjusted();
    return UNISIM_PREDICTION_OK;
  });
}

/// One line on why there is no map.
std::string why_no_start(const GeometricPredictor& me) {
  std::string line;
  if (me.mapper) line = start_report(me.mapper->start_statistics(), me.size);
  if (me.left_out == 0) return line;
  line += line.empty() ? "no start: " : "; ";
  return line + std::to_string(me.left_out) + " frames left out, the last: " + me.left_out_why;
}

void info(unisim_predictor* predictor, unisim_predictor_info* out) {
  GeometricPredictor* me = self(predictor);
  *out = {};
  out->static_frames = me->static_frames;
  if (!me->mapper || me->mapper->counts().started == 0) {
    guarded(predictor, [&](GeometricPredictor*) {
      me->no_start = why_no_start(*me);
      if (!me->no_start.empty()) out->no_start = me->no_start.c_str();
      return UNISIM_PREDICTION_OK;
    });
  }
  if (!me->mapper) return;
  const Intrinsics& intrinsics = me->mapper->state().intrinsics;
  const MapperCounts& counts = me->mapper->counts();
  out->initialised = counts.started > 0 ? 1 : 0;
  out->restarts = counts.restarts;
  out->rotation_only = counts.rotation_only;
  me->mapper->places().info(out);
  out->state_bytes = me->mapper->bytes() + me->predictions->bytes() + me->view.bytes();
  if (out->initialised == 0) return;
  out->focal_px = intrinsics.camera.focal_px;
  out->focal_sigma_px = intrinsics.focal_sigma() * intrinsics.camera.focal_px;
  out->radial_k1 = intrinsics.camera.k1;
  out->center_x_px = intrinsics.camera.cx - intrinsics.middle.x;
  out->center_y_px = intrinsics.camera.cy - intrinsics.middle.y;
  out->readout_ms = 1e3 * intrinsics.readout_s;
}

/// Copies the mask's pixels.
void own_mask(GeometricPredictor* me) {
  unisim_image& mask = me->config.mask;
  if (mask.data == nullptr) return;
  const size_t bytes = static_cast<size_t>(mask.stride) * static_cast<size_t>(mask.height - 1) +
                       static_cast<size_t>(mask.width);
  me->mask.assign(mask.data, mask.data + bytes);
  mask.data = me->mask.data();
}

const char* message(unisim_predictor* predictor) { return self(predictor)->message.c_str(); }

void destroy(unisim_predictor* predictor) { delete self(predictor); }

}  // namespace
}  // namespace unisim::geometric

unisim_predictor* unisim_geometric_create(const unisim_geometric_config* config, char* message,
                                          size_t capacity) {
  namespace g = unisim::geometric;
  std::string problem;
  try {
    auto made = std::make_unique<g::GeometricPredictor>();
    problem = g::read_config(config, &made->config);
    if (problem.empty()) {
      g::own_mask(made.get());
      made->given = made->config;
      unisim_predictor& table = made->table;
      table.struct_size = sizeof table;
      table.name = "geometric";
      table.needs_images = 1;
      table.observe = g::observe;
      table.keyframe = g::keyframe;
      table.two_view = g::two_view;
      table.multi_view = g::multi_view;
      table.next_revision = g::next_revision;
      table.next_wide_window = g::next_wide_window;
      table.frame_pose = g::frame_pose;
      table.finish = g::finish;
      table.info = g::info;
      table.message = g::message;
      table.destroy = g::destroy;
      table.features = g::features;
      g::fill_map_calls(&table);
      return &made.release()->table;
    }
  } catch (const std::exception& error) {
    problem = std::string("geometric: ") + error.what();
  }
  if (message != nullptr && capacity > 0) std::snprintf(message, capacity, "%s", problem.c_str());
  return nullptr;
}

void unisim_geometric_view(unisim_predictor* predictor, const unisim_image* image,
                           unisim_image* out) {
  namespace g = unisim::geometric;
  *out = *image;
  if (predictor->destroy != g::destroy || image->data == nullptr) return;
  g::guarded(predictor, [&](g::GeometricPredictor* me) {
    const bool same = image->width == me->size.width && image->height == me->size.height;
    if (me->view.active() && same) *out = me->view.run(*image, false);
    return UNISIM_PREDICTION_OK;
  });
}
