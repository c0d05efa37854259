// SPDX-License-Identifier: MIT
// The calls of the table that are about maps which outlive the run.
#include <algorithm>
#include <cstdio>
#include <utility>

#include "drivers/common/size_text.hpp"
#include "drivers/geometric/config.hpp"
#include "drivers/geometric/predictor_self.hpp"

namespace unisim::geometric {
namespace {

constexpr uint32_t kMapVersion = 2;
constexpr int32_t kLeastSide = 64;  // pixels
constexpr int32_t kMostSide = 16384;
constexpr double kMostNumber = 1e9;

/// What was said of the camera when the map was made.
void archive_camera(drivers::Archive* io, unisim_geometric_config* c) {
  for (double* number : {&c->focal_px, &c->focal_y_px, &c->principal_x_px, &c->principal_y_px}) {
    io->number(*number, 0.0, kMostNumber);
  }
  io->number(c->distortion_model);
  io->number(c->calibrated_width);
  io->number(c->calibrated_height);
  for (double& term : c->distortion) io->number(term, -kMostNumber, kMostNumber);
}

bool says_nothing(const unisim_geometric_config& c) {
  return c.focal_px == 0 && c.principal_x_px == 0;
}

bool same_camera(const unisim_geometric_config& a, const unisim_geometric_config& b) {
  return a.focal_px == b.focal_px && a.focal_y_px == b.focal_y_px &&
         a.principal_x_px == b.principal_x_px && a.principal_y_px == b.principal_y_px &&
         a.distortion_model == b.distortion_model && a.calibrated_width == b.calibrated_width &&
         a.calibrated_height == b.calibrated_height &&
         std::equal(a.distortion, a.distortion + UNISIM_DISTORTION_TERMS, b.distortion);
}

std::string camera_text(const unisim_geometric_config& c) {
  if (says_nothing(c)) return "one whose numbers were estimated";
  if (c.focal_px == 0) return "one with a given principal point";
  char focal[32];
  std::snprintf(focal, sizeof focal, "%.1f", c.focal_px);
  return std::string("one with a given focal length of ") + focal + " pixels" +
         (c.distortion_model != UNISIM_DISTORTION_UNKNOWN ? " and a given lens" : "");
}

/// Takes the map's camera, which must be the one that was given here, if one was.
void take_camera(drivers::Archive* io, unisim_geometric_config* config) {
  unisim_geometric_config of_map = *config;
  archive_camera(io, &of_map);
  unisim_geometric_config checked{};
  if (!read_config(&of_map, &checked).empty()) io->fail("it is none");
  if (!says_nothing(*config) && !same_camera(*config, of_map)) {
    io->fail("the map was made with " + camera_text(of_map) + ", this is " + camera_text(*config) +
             "; say nothing of the camera, then the map's is taken, or make a map with this one");
  }
  *config = of_map;
}

void archive_size(drivers::Archive* io, cv::Size* size) {
  io->number(size->width, kLeastSide, kMostSide);
  io->number(size->height, kLeastSide, kMostSide);
}

void archive_version(drivers::Archive* io) {
  io->part("version");
  uint32_t version = kMapVersion;
  io->number(version);
  if (io->reading() && version > kMapVersion) {
    io->fail("the map is of version " + std::to_string(version) + ", this program reads up to " +
             std::to_string(kMapVersion) + "; use a newer one");
  }
  if (version > 0 && version < kMapVersion) {
    io->fail("the map is of version " + std::to_string(version) + ", this program reads " +
             std::to_string(kMapVersion) + " only; map the place anew");
  }
  io->require(version == kMapVersion, "not one of a geometric predictor");
}

int save_map(unisim_predictor* predictor, unisim_map_write write, void* context) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper || !me->mapper->has_map()) {
      me->message = "geometric: there is no map yet";
      return UNISIM_PREDICTION_REJECTED;
    }
    try {
      drivers::Archive io(write, context);
      archive_version(&io);
      archive_size(&io, &me->size);
      archive_camera(&io, &me->given);
      me->mapper->archive(&io);
    } catch (const drivers::ArchiveError& error) {
      me->message = std::string("geometric: ") + error.what();
      return UNISIM_PREDICTION_REJECTED;
    }
    return UNISIM_PREDICTION_OK;
  });
}

/// A predictor's parts with the map in them.
struct LoadedMap {
  cv::Size size;
  unisim_geometric_config given{};
  unisim_geometric_config config{};
  IdealView view;
  std::unique_ptr<Mapper> mapper;
};

LoadedMap read_map(drivers::Archive* io, const GeometricPredictor& me) {
  LoadedMap out;
  archive_version(io);
  io->part("camera");
  archive_size(io, &out.size);
  const unisim_image& mask = me.given.mask;
  if (mask.data != nullptr && cv::Size(mask.width, mask.height) != out.size) {
    io->fail("the map's images have " + drivers::size_text(out.size.width, out.size.height) +
             " pixels, the mask " + drivers::size_text(mask.width, mask.height) +
             "; give a mask of the map's size");
  }
  out.given = me.given;
  take_camera(io, &out.given);
  out.config = out.given;
  const std::string problem = out.view.open(out.size, &out.config);
  if (!problem.empty()) io->fail(problem);
  out.mapper = std::make_unique<Mapper>(out.config, out.size);
  out.mapper->archive(io);
  return out;
}

int load_map(unisim_predictor* predictor, unisim_map_read read, void* context,
             int32_t* next_keyframe) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (me->mapper) {
      me->message = "geometric: a map is loaded before the first frame";
      return UNISIM_PREDICTION_REJECTED;
    }
    try {
      drivers::Archive io(read, context);
      LoadedMap map = read_map(&io, *me);
      me->predictions = std::make_unique<Predictions>(map.config, map.size);
      me->mapper = std::move(map.mapper);
      me->view = std::move(map.view);
      me->config = map.config;
      me->given = map.given;
      me->size = map.size;
    } catch (const drivers::ArchiveError& error) {
      me->message = std::string("geometric: ") + error.what();
      return UNISIM_PREDICTION_REJECTED;
    }
    me->loaded = true;
    me->keyframes = me->mapper->state().map.end_id();
    *next_keyframe = me->keyframes;
    return UNISIM_PREDICTION_OK;
  });
}

int locate(unisim_predictor* predictor, const unisim_frame* frame, unisim_location* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    if (!me->mapper || !me->mapper->has_map()) {
      me->message = "geometric: there is no map to look for the frame in";
      return UNISIM_PREDICTION_REJECTED;
    }
    if (!accept_image(me, frame->image)) return UNISIM_PREDICTION_REJECTED;
    const unisim_image seen = me->view.active() ? me->view.run(frame->image, true) : frame->image;
    bool followed = false;
    if (!me->mapper->locate(seen, &me->located, &followed)) {
      me->message = "geometric: the frame shows nothing that the map is sure of";
      return UNISIM_PREDICTION_REJECTED;
    }
    *out = {};
    out->T_map_frame = to_sim3(me->located.pose);
    out->keyframe_id = me->located.keyframe;
    out->segment = me->mapper->state().map.keyframe(me->located.keyframe).segment;
    out->inliers = static_cast<int32_t>(me->located.matches.size());
    out->in_view = me->located.in_view;
    out->followed = followed ? 1 : 0;
    return UNISIM_PREDICTION_OK;
  });
}

int map_pose(unisim_predictor* predictor, int32_t id, unisim_map_pose* out) {
  return guarded(predictor, [&](GeometricPredictor* me) {
    const bool held = me->mapper && me->mapper->state().map.holds(id);
    if (!held || !me->mapper->state().map.keyframe(id).posed) {
      me->message = "geometric: the map has no pose of keyframe " + std::to_string(id);
      return UNISIM_PREDICTION_REJECTED;
    }
    const Keyframe& keyframe = me->mapper->state().map.keyframe(id);
    *out = {to_sim3(keyframe.pose), keyframe.segment, 0};
    return UNISIM_PREDICTION_OK;
  });
}

}  // namespace

void fill_map_calls(unisim_predictor* table) {
  table->save_map = save_map;
  table->load_map = load_map;
  table->locate = locate;
  table->map_pose = map_pose;
}

}  // namespace unisim::geometric
