// SPDX-License-Identifier: MIT
// A predictor that hands every call on and stores the answers.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <string>

#include "drivers/common/has_maps.hpp"
#include "drivers/common/has_places.hpp"
#include "drivers/recorded/prediction_codec.hpp"
#include "drivers/recorded/record_format.hpp"
#include "drivers/recorded/record_writer.hpp"
#include "drivers/recorded/recorded.h"
#include "drivers/recorded/recorded_file.hpp"

namespace unisim::recorded {
namespace {

struct Recorder : unisim_predictor {
  unisim_predictor* inner = nullptr;
  RecordWriter writer;
  FileInfo file;
  bool header_written = false;
  Moment moment;
  Moment back_moment;  ///< of windows, where they are asked for beside the tracking
  std::mutex mutex;    ///< of the writer: then two threads store

  const Moment& window_moment() const { return concurrent_windows != 0 ? back_moment : moment; }
};

Recorder& self(unisim_predictor* predictor) { return *static_cast<Recorder*>(predictor); }

const char* reason_of(const Recorder& recorder, Kind kind) {
  const bool back = kind == Kind::kWindow || kind == Kind::kRevision || kind == Kind::kWideWindow;
  unisim_predictor* const inner = recorder.inner;
  return back && inner->window_message != nullptr ? inner->window_message(inner)
                                                  : inner->message(inner);
}

/// Writes one record: `put_key` its key, `put_data` the data of an OK answer.
/// The data of a rejected answer is the reason, of a pending one nothing.
template <class PutKey, class PutData>
void store(Recorder& recorder, Kind kind, int status, PutKey put_key, PutData put_data) {
  const std::lock_guard<std::mutex> lock(recorder.mutex);
  if (!recorder.writer.active() || status == UNISIM_PREDICTION_FAILED) return;
  try {
    RecordWriter& writer = recorder.writer;
    writer.begin(kind);
    put_key(writer.bytes());
    writer.end_key();
    if (status == UNISIM_PREDICTION_OK) put_data(writer.bytes());
    if (status == UNISIM_PREDICTION_REJECTED) {
      const char* reason = reason_of(recorder, kind);
      if (reason != nullptr) writer.bytes().put_array(reason, std::strlen(reason));
    }
    writer.end();
  } catch (const std::bad_alloc&) {
    recorder.writer.stop("not enough memory");
  }
}

constexpr auto kNoData = [](RecordBytes&) {};

void write_header(Recorder& recorder, int32_t width, int32_t height) {
  if (recorder.header_written) return;
  recorder.header_written = true;
  // Of a recording that is recorded again the images may be gone.
  if (width <= 0 || height <= 0) unisim_predictor_recorded_size(recorder.inner, &width, &height);
  recorder.file.image_width = width;
  recorder.file.image_height = height;
  try {
    recorder.writer.write_header(recorder.file);
  } catch (const std::bad_alloc&) {
    recorder.writer.stop("not enough memory");
  }
}

int observe(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion) {
  Recorder& recorder = self(predictor);
  *motion = {-1.0, -1.0, 0, 0};
  const int status = recorder.inner->observe(recorder.inner, frame, motion);
  write_header(recorder, frame->image.width, frame->image.height);
  recorder.moment.frame = frame->index;
  store(
      recorder, Kind::kFrame, status,
      [&](RecordBytes& bytes) {
        bytes.put(FrameKey{frame->index, frame->timestamp_ns, motion->flow, motion->tracked, status,
                           motion->reason});
      },
      kNoData);
  return status;
}

int keyframe(unisim_predictor* predictor, const unisim_frame* frame, int32_t id) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->keyframe(recorder.inner, frame, id);
  write_header(recorder, frame->image.width, frame->image.height);
  recorder.moment.keyframe = id;
  store(
      recorder, Kind::kKeyframe, status,
      [&](RecordBytes& bytes) { bytes.put(KeyframeKey{frame->index, frame->timestamp_ns, id, 0}); },
      kNoData);
  return status;
}

int two_view(unisim_predictor* predictor, int32_t i, int32_t j, unisim_pair_prediction* out) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->two_view(recorder.inner, i, j, out);
  store(
      recorder, Kind::kPair, status,
      [&](RecordBytes& bytes) { bytes.put(PairKey{recorder.moment, status, i, j, 0}); },
      [&](RecordBytes& bytes) { encode_pair(*out, &bytes); });
  return status;
}

int multi_view(unisim_predictor* predictor, const int32_t* ids, int32_t count,
               unisim_window_prediction* out) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->multi_view(recorder.inner, ids, count, out);
  recorder.back_moment.keyframe = std::max(recorder.back_moment.keyframe, ids[count - 1]);
  store(
      recorder, Kind::kWindow, status,
      [&](RecordBytes& bytes) {
        bytes.put(WindowKey{recorder.window_moment(), status, count});
        bytes.put_array(ids, static_cast<std::size_t>(count));
      },
      [&](RecordBytes& bytes) { encode_window(*out, &bytes); });
  return status;
}

int next_revision(unisim_predictor* predictor, unisim_window_revision* out) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->next_revision(recorder.inner, out);
  if (status != UNISIM_PREDICTION_OK) return status;
  store(
      recorder, Kind::kRevision, status,
      [&](RecordBytes& bytes) { bytes.put(RevisionKey{recorder.window_moment(), out->token}); },
      [&](RecordBytes& bytes) { encode_revision(*out, &bytes); });
  return status;
}

int next_wide_window(unisim_predictor* predictor, int32_t max_views,
                     unisim_window_prediction* out) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->next_wide_window(recorder.inner, max_views, out);
  if (status != UNISIM_PREDICTION_OK) return status;
  store(
      recorder, Kind::kWideWindow, status,
      [&](RecordBytes& bytes) { bytes.put(WideWindowKey{recorder.window_moment()}); },
      [&](RecordBytes& bytes) { encode_window(*out, &bytes); });
  return status;
}

int frame_pose(unisim_predictor* predictor, unisim_frame_pose* out) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->frame_pose(recorder.inner, out);
  const int32_t id = status == UNISIM_PREDICTION_OK ? out->keyframe_id : -1;
  store(
      recorder, Kind::kFramePose, status,
      [&](RecordBytes& bytes) { bytes.put(FramePoseKey{recorder.moment, status, id}); },
      [&](RecordBytes& bytes) { bytes.put(out->T_kf_frame); });
  return status;
}

int place_descriptor(unisim_predictor* predictor, int32_t id, unisim_place_descriptor* out) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->place_descriptor(recorder.inner, id, out);
  store(
      recorder, Kind::kPlace, status,
      [&](RecordBytes& bytes) { bytes.put(PlaceKey{recorder.moment, status, id}); },
      [&](RecordBytes& bytes) { encode_place(*out, &bytes); });
  return status;
}

void release_place(unisim_predictor* predictor, int32_t id) {
  Recorder& recorder = self(predictor);
  recorder.inner->release_place(recorder.inner, id);
}

int save_map(unisim_predictor* predictor, unisim_map_write write, void* context) {
  Recorder& recorder = self(predictor);
  return recorder.inner->save_map(recorder.inner, write, context);
}

/// The recording would begin amidst a map that its replay does not have.
int load_map(unisim_predictor* predictor, unisim_map_read read, void* context,
             int32_t* next_keyframe) {
  Recorder& recorder = self(predictor);
  recorder.writer.stop("a run that goes on in a map is not recorded");
  return recorder.inner->load_map(recorder.inner, read, context, next_keyframe);
}

int locate(unisim_predictor* predictor, const unisim_frame* frame, unisim_location* out) {
  Recorder& recorder = self(predictor);
  return recorder.inner->locate(recorder.inner, frame, out);
}

int map_pose(unisim_predictor* predictor, int32_t id, unisim_map_pose* out) {
  Recorder& recorder = self(predictor);
  return recorder.inner->map_pose(recorder.inner, id, out);
}

int32_t features(unisim_predictor* predictor, const unisim_feature** out) {
  Recorder& recorder = self(predictor);
  return recorder.inner->features(recorder.inner, out);
}

int finish(unisim_predictor* predictor) {
  Recorder& recorder = self(predictor);
  const int status = recorder.inner->finish(recorder.inner);
  recorder.moment.finished = recorder.back_moment.finished = 1;
  return status;
}

void info(unisim_predictor* predictor, unisim_predictor_info* out) {
  Recorder& recorder = self(predictor);
  recorder.inner->info(recorder.inner, out);
}

const char* message(unisim_predictor* predictor) {
  Recorder& recorder = self(predictor);
  return recorder.inner->message(recorder.inner);
}

const char* window_message(unisim_predictor* predictor) {
  Recorder& recorder = self(predictor);
  return recorder.inner->window_message(recorder.inner);
}

void write_end(Recorder& recorder) {
  write_header(recorder, 0, 0);
  unisim_predictor_info last{};
  recorder.inner->info(recorder.inner, &last);
  store(
      recorder, Kind::kInfo, UNISIM_PREDICTION_OK,
      [&](RecordBytes& bytes) {
        bytes.put(InfoKey{last.focal_px, last.focal_sigma_px, last.radial_k1, last.state_bytes,
                          last.initialised, last.restarts, last.rotation_only, last.static_frames});
        bytes.put(InfoCenter{last.center_x_px, last.center_y_px});
      },
      kNoData);
  store(
      recorder, Kind::kEnd, UNISIM_PREDICTION_OK,
      [&](RecordBytes& bytes) { bytes.put(EndKey{recorder.writer.record_count()}); }, kNoData);
}

void destroy(unisim_predictor* predictor) {
  if (predictor == nullptr) return;
  Recorder& recorder = self(predictor);
  write_end(recorder);
  recorder.inner->destroy(recorder.inner);
  delete &recorder;
}

void fill_table(Recorder* recorder, unisim_predictor* inner) {
  recorder->inner = inner;
  recorder->struct_size = sizeof(unisim_predictor);
  recorder->name = inner->name;
  recorder->needs_images = inner->needs_images;
  recorder->concurrent_windows = inner->concurrent_windows;
  recorder->file.concurrent_windows = inner->concurrent_windows != 0;
  recorder->observe = observe;
  recorder->keyframe = keyframe;
  recorder->two_view = two_view;
  recorder->multi_view = multi_view;
  recorder->next_revision = inner->next_revision != nullptr ? next_revision : nullptr;
  recorder->next_wide_window = inner->next_wide_window != nullptr ? next_wide_window : nullptr;
  recorder->frame_pose = inner->frame_pose != nullptr ? frame_pose : nullptr;
  recorder->finish = inner->finish != nullptr ? finish : nullptr;
  recorder->info = info;
  recorder->message = message;
  recorder->window_message = inner->window_message != nullptr ? window_message : nullptr;
  recorder->destroy = destroy;
  recorder->features = inner->features != nullptr ? features : nullptr;
  if (drivers::has_maps(*inner)) {
    recorder->save_map = save_map;
    recorder->load_map = load_map;
    recorder->locate = locate;
    recorder->map_pose = map_pose;
  }
  if (!drivers::has_places(*inner)) return;
  recorder->place_descriptor = place_descriptor;
  recorder->release_place = release_place;
}

/// The predictor that recorders, one in another, hand their calls on to.
const unisim_predictor* innermost(const unisim_predictor* predictor) {
  while (predictor->destroy == destroy) predictor = static_cast<const Recorder*>(predictor)->inner;
  return predictor;
}

}  // namespace
}  // namespace unisim::recorded

unisim_predictor* unisim_recorder_create(unisim_predictor* inner, const char* path,
                                         const char* sequence_name, char* message,
                                         size_t message_size) {
  using unisim::recorded::Recorder;
  try {
    auto recorder = std::make_unique<Recorder>();
    if (!recorder->writer.open(path)) {
      if (message != nullptr) {
        std::snprintf(message, message_size, "%s", recorder->writer.problem().c_str());
      }
      return nullptr;
    }
    recorder->file.creator = "libunisim " UNISIM_RECORDER_VERSION;
    recorder->file.sequence = sequence_name != nullptr ? sequence_name : "";
    recorder->file.predictor = unisim_predictor_origin(inner);
    unisim::recorded::fill_table(recorder.get(), inner);
    return recorder.release();
  } catch (const std::bad_alloc&) {
    if (message != nullptr) std::snprintf(message, message_size, "recorder: not enough memory");
    return nullptr;
  }
}

const char* unisim_recorder_problem(const unisim_predictor* recorder) {
  return static_cast<const unisim::recorded::Recorder*>(recorder)->writer.problem().c_str();
}

unisim_predictor* unisim_predictor_inside(unisim_predictor* predictor) {
  return const_cast<unisim_predictor*>(unisim::recorded::innermost(predictor));
}

const char* unisim_predictor_origin(const unisim_predictor* predictor) {
  const unisim_predictor* inside = unisim::recorded::innermost(predictor);
  const unisim::recorded::FileInfo* file = unisim::recorded::recorded_file(inside);
  return file != nullptr ? file->predictor.c_str() : inside->name;
}

int unisim_predictor_recorded_size(const unisim_predictor* predictor, int32_t* width,
                                   int32_t* height) {
  const auto* file = unisim::recorded::recorded_file(unisim::recorded::innermost(predictor));
  if (file == nullptr || file->image_width <= 0 || file->image_height <= 0) return 0;
  *width = file->image_width;
  *height = file->image_height;
  return 1;
}
