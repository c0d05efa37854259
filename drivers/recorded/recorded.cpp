// SPDX-License-Identifier: MIT
// A predictor that gives the predictions of a file.
#include "drivers/recorded/recorded.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <string>

#include "drivers/recorded/prediction_codec.hpp"
#include "drivers/recorded/record_format.hpp"
#include "drivers/recorded/record_index.hpp"
#include "drivers/recorded/record_reader.hpp"
#include "drivers/recorded/recorded_file.hpp"

namespace unisim::recorded {
namespace {

/// What one group of functions (drivers/predictor.h) knows and says.
struct Group {
  Moment now;
  std::string text;
};

struct Recorded : unisim_predictor {
  std::string path;
  RecordReader reader;
  RecordIndex index;
  std::mutex mutex;  ///< of all below: the groups run beside each other
  Group front;
  Group back;
  std::size_t next_revision_at = 0;
  std::size_t next_wide_at = 0;
  DecodedArrays pair;
  DecodedArrays window;
  DecodedArrays revision;
  DecodedArrays wide;
  DecodedArrays place;
  AlignedBytes scratch;
};

Recorded& self(unisim_predictor* predictor) { return *static_cast<Recorded*>(predictor); }

int reject(Group& group, const std::string& why) {
  group.text = why;
  return UNISIM_PREDICTION_REJECTED;
}

int fail(Group& group, const std::string& why) {
  group.text = why;
  return UNISIM_PREDICTION_FAILED;
}

/// One call at a time, without C++ exceptions (memory) on the other side of the table.
template <class Function>
int guarded(Recorded& recorded, Group& group, Function function) {
  try {
    const std::lock_guard<std::mutex> lock(recorded.mutex);
    return function();
  } catch (const std::bad_alloc&) {
    return fail(group, "not enough memory to read " + recorded.path);
  } catch (const std::exception& error) {
    return fail(group, recorded.path + ": " + error.what());
  }
}

/// Reason stored with a rejected answer.
int repeat_rejection(Recorded& recorded, Group& group, const RecordRef& record) {
  if (!recorded.reader.read_data(record, &recorded.scratch)) {
    return fail(group, recorded.reader.problem());
  }
  const auto* text = reinterpret_cast<const char*>(recorded.scratch.data());
  std::string why(text, static_cast<std::size_t>(record.head.data_bytes));
  why.resize(why.find('\0') != std::string::npos ? why.find('\0') : why.size());
  return reject(group, why.empty() ? "rejected in the recording" : why);
}

std::string absent(const Recorded& recorded) {
  if (recorded.index.complete()) {
    return "not in " + recorded.path +
           ": recorded with other options (keyframes, --window, --overlap, --stride)";
  }
  return "not in " + recorded.path + ": that recording was cut off at keyframe " +
         std::to_string(static_cast<std::int64_t>(recorded.index.keyframes().size()) - 1) +
         " or made with other options";
}

/// Answers a question; `decode` reads the data of an OK answer.
template <class Decode>
int answer(Recorded& recorded, Group& group, const Question& question, const std::string& what,
           DecodedArrays* arrays, Decode decode) {
  RecordedAnswers* answers = recorded.index.find_answers(question);
  if (answers == nullptr) return reject(group, absent(recorded));
  RecordedAnswer* due = due_answer(answers, group.now);
  if (due == nullptr) return UNISIM_PREDICTION_PENDING;
  due->given = true;
  if (due->status == UNISIM_PREDICTION_REJECTED)
    return repeat_rejection(recorded, group, due->record);
  if (!recorded.reader.read_data(due->record, &arrays->data)) {
    return fail(group, recorded.reader.problem());
  }
  std::string problem;
  const Decoded decoded = decode(static_cast<std::size_t>(due->record.head.data_bytes), &problem);
  if (decoded == Decoded::kOk) return UNISIM_PREDICTION_OK;
  recorded.reader.damaged(due->record.offset, what + ": " + problem);
  return decoded == Decoded::kNotFinite ? reject(group, recorded.reader.problem())
                                        : fail(group, recorded.reader.problem());
}

/// A frame of the run must be the frame of the recording.
bool same_time(const RecordedFrame& recorded, const unisim_frame& frame) {
  return recorded.timestamp_ns == kUnknownTime || recorded.timestamp_ns == frame.timestamp_ns;
}

std::string other_time(const Recorded& recorded, const unisim_frame& frame, std::int64_t time_ns) {
  return "frame " + std::to_string(frame.index) + " has time " +
         std::to_string(frame.timestamp_ns) + " ns, in " + recorded.path + " " +
         std::to_string(time_ns) + " ns: recorded from another sequence";
}

/// Where windows were not asked for beside the tracking, their moments are those of the tracking.
void follow_front(Recorded* recorded) {
  if (recorded->concurrent_windows == 0) recorded->back.now = recorded->front.now;
}

int observe(unisim_predictor* predictor, const unisim_frame* frame, unisim_motion* motion) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.front, [&] {
    const RecordIndex& index = recorded.index;
    *motion = {-1.0, -1.0, 0, 0};
    recorded.front.now.frame = frame->index;
    follow_front(&recorded);
    const RecordedFrame* keyframe = index.find_keyframe(frame->index);
    const RecordedFrame* seen = index.find_frame(frame->index);
    for (const RecordedFrame* known : {keyframe, seen}) {
      if (known != nullptr && !same_time(*known, *frame)) {
        return fail(recorded.front, other_time(recorded, *frame, known->timestamp_ns));
      }
    }
    if (!index.keyframes().empty()) motion->keyframe_advice = keyframe != nullptr ? 1 : -1;
    if (seen != nullptr) {
      motion->flow = seen->flow;
      motion->tracked = seen->tracked;
      motion->reason = seen->reason;
      if (seen->status != UNISIM_PREDICTION_OK)
        return repeat_rejection(recorded, recorded.front, seen->record);
    } else if (!index.frames().empty()) {
      const std::int64_t first = index.frames().front().index;
      const std::int64_t last = index.frames().back().index;
      return reject(recorded.front, "not in " + recorded.path + ", which was made with --from " +
                                        std::to_string(first) + " --to " +
                                        std::to_string(last + 1));
    }
    return UNISIM_PREDICTION_OK;
  });
}

int keyframe(unisim_predictor* predictor, const unisim_frame* frame, int32_t id) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.front, [&] {
    recorded.front.now.keyframe = id;
    follow_front(&recorded);
    const auto& keyframes = recorded.index.keyframes();
    if (keyframes.empty()) return UNISIM_PREDICTION_OK;
    const auto at = static_cast<std::size_t>(id);
    if (at >= keyframes.size()) {
      return fail(recorded.front, "keyframe " + std::to_string(id) + " is not in " + recorded.path +
                                      ", which has " + std::to_string(keyframes.size()) +
                                      ": use the same --stride, --from and --to");
    }
    if (keyframes[at].index == frame->index) return UNISIM_PREDICTION_OK;
    return fail(recorded.front, "keyframe " + std::to_string(id) + " is frame " +
                                    std::to_string(frame->index) + ", in " + recorded.path +
                                    " frame " + std::to_string(keyframes[at].index) +
                                    ": use the same --stride and --from");
  });
}

int two_view(unisim_predictor* predictor, int32_t i, int32_t j, unisim_pair_prediction* out) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.front, [&] {
    const std::string what = "pair " + std::to_string(i) + "," + std::to_string(j);
    return answer(recorded, recorded.front, pair_question(i, j), what, &recorded.pair,
                  [&](std::size_t size, std::string* problem) {
                    return decode_pair(size, &recorded.pair, out, problem);
                  });
  });
}

int multi_view(unisim_predictor* predictor, const int32_t* ids, int32_t count,
               unisim_window_prediction* out) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.back, [&] {
    recorded.back.now.keyframe = std::max(recorded.back.now.keyframe, ids[count - 1]);
    const std::string what = "window of " + std::to_string(count) + " keyframes " +
                             std::to_string(ids[0]) + ".." + std::to_string(ids[count - 1]);
    return answer(recorded, recorded.back, window_question(ids, count), what, &recorded.window,
                  [&](std::size_t size, std::string* problem) {
                    return decode_window(size, &recorded.window, out, problem);
                  });
  });
}

int next_revision(unisim_predictor* predictor, unisim_window_revision* out) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.back, [&] {
    const auto& revisions = recorded.index.revisions();
    if (recorded.next_revision_at == revisions.size()) return UNISIM_PREDICTION_PENDING;
    const RecordedRevision& next = revisions[recorded.next_revision_at];
    if (!has_come(next.moment, recorded.back.now)) return UNISIM_PREDICTION_PENDING;
    ++recorded.next_revision_at;
    if (!recorded.reader.read_data(next.record, &recorded.revision.data)) {
      return fail(recorded.back, recorded.reader.problem());
    }
    out->token = next.token;
    std::string problem;
    const auto size = static_cast<std::size_t>(next.record.head.data_bytes);
    const Decoded decoded = decode_revision(size, &recorded.revision, out, &problem);
    if (decoded == Decoded::kOk) return UNISIM_PREDICTION_OK;
    recorded.reader.damaged(next.record.offset, "revision: " + problem);
    return decoded == Decoded::kNotFinite ? reject(recorded.back, recorded.reader.problem())
                                          : fail(recorded.back, recorded.reader.problem());
  });
}

int next_wide_window(unisim_predictor* predictor, int32_t max_views,
                     unisim_window_prediction* out) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.back, [&] {
    const auto& windows = recorded.index.wide_windows();
    if (recorded.next_wide_at == windows.size()) return UNISIM_PREDICTION_PENDING;
    const RecordedWideWindow& next = windows[recorded.next_wide_at];
    if (!has_come(next.moment, recorded.back.now)) return UNISIM_PREDICTION_PENDING;
    ++recorded.next_wide_at;
    if (!recorded.reader.read_data(next.record, &recorded.wide.data)) {
      return fail(recorded.back, recorded.reader.problem());
    }
    std::string problem;
    const auto size = static_cast<std::size_t>(next.record.head.data_bytes);
    const Decoded decoded = decode_window(size, &recorded.wide, out, &problem);
    if (decoded == Decoded::kOk && out->count <= max_views) return UNISIM_PREDICTION_OK;
    if (decoded == Decoded::kOk) return reject(recorded.back, "wide window larger than --window");
    recorded.reader.damaged(next.record.offset, "wide window: " + problem);
    return decoded == Decoded::kNotFinite ? reject(recorded.back, recorded.reader.problem())
                                          : fail(recorded.back, recorded.reader.problem());
  });
}

int frame_pose(unisim_predictor* predictor, unisim_frame_pose* out) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.front, [&] {
    const std::int64_t frame = recorded.front.now.frame;
    RecordedAnswers* answers = recorded.index.find_answers(frame_pose_question(frame));
    RecordedAnswer* due = answers != nullptr ? due_answer(answers, recorded.front.now) : nullptr;
    if (due == nullptr) return UNISIM_PREDICTION_PENDING;
    due->given = true;
    if (due->status == UNISIM_PREDICTION_REJECTED)
      return repeat_rejection(recorded, recorded.front, due->record);
    if (!recorded.reader.read_data(due->record, &recorded.scratch)) {
      return fail(recorded.front, recorded.reader.problem());
    }
    out->keyframe_id = due->keyframe_id;
    if (decode_pose(static_cast<std::size_t>(due->record.head.data_bytes), recorded.scratch,
                    &out->T_kf_frame) == Decoded::kOk) {
      return UNISIM_PREDICTION_OK;
    }
    recorded.reader.damaged(due->record.offset,
                            "pose of frame " + std::to_string(frame) + " is not a number");
    return reject(recorded.front, recorded.reader.problem());
  });
}

int place_descriptor(unisim_predictor* predictor, int32_t id, unisim_place_descriptor* out) {
  Recorded& recorded = self(predictor);
  return guarded(recorded, recorded.front, [&] {
    const std::string what = "place " + std::to_string(id);
    return answer(recorded, recorded.front, place_question(id), what, &recorded.place,
                  [&](std::size_t size, std::string* problem) {
                    return decode_place(size, &recorded.place, out, problem);
                  });
  });
}

int finish(unisim_predictor* predictor) {
  Recorded& recorded = self(predictor);
  recorded.front.now.finished = recorded.back.now.finished = 1;
  return UNISIM_PREDICTION_OK;
}

void info(unisim_predictor* predictor, unisim_predictor_info* out) {
  Recorded& recorded = self(predictor);
  *out = recorded.index.info();
  std::size_t bytes = sizeof recorded + recorded.index.bytes() + recorded.scratch.capacity_bytes();
  for (const DecodedArrays* arrays :
       {&recorded.pair, &recorded.window, &recorded.revision, &recorded.wide, &recorded.place}) {
    bytes += arrays->data.capacity_bytes();
  }
  out->state_bytes = static_cast<std::int64_t>(bytes);
}

const char* message(unisim_predictor* predictor) { return self(predictor).front.text.c_str(); }

const char* window_message(unisim_predictor* predictor) {
  return self(predictor).back.text.c_str();
}

void destroy(unisim_predictor* predictor) {
  if (predictor != nullptr) delete &self(predictor);
}

void fill_table(Recorded* recorded) {
  recorded->struct_size = sizeof(unisim_predictor);
  recorded->name = "recorded";
  // A file that names neither frames nor keyframes does not tell which images could be read.
  const RecordIndex& index = recorded->index;
  recorded->needs_images = index.frames().empty() && index.keyframes().empty() ? 1 : 0;
  recorded->concurrent_windows = recorded->reader.info().concurrent_windows ? 1 : 0;
  recorded->observe = observe;
  recorded->keyframe = keyframe;
  recorded->two_view = two_view;
  recorded->multi_view = multi_view;
  recorded->next_revision = next_revision;
  recorded->next_wide_window = next_wide_window;
  recorded->frame_pose = recorded->index.has_frame_poses() ? frame_pose : nullptr;
  recorded->finish = finish;
  recorded->info = info;
  recorded->message = message;
  recorded->window_message = window_message;
  if (recorded->index.has_places()) {
    recorded->place_descriptor = place_descriptor;
    recorded->release_place = [](unisim_predictor*, int32_t) {};
  }
  recorded->destroy = destroy;
}

void say(char* message, std::size_t size, const std::string& text) {
  if (message != nullptr && size > 0) std::snprintf(message, size, "%s", text.c_str());
}

}  // namespace

const FileInfo* recorded_file(const unisim_predictor* predictor) {
  if (predictor->destroy != destroy) return nullptr;
  return &static_cast<const Recorded*>(predictor)->reader.info();
}

}  // namespace unisim::recorded

int unisim_recorded_windows(const unisim_predictor* recorded, int32_t* size, int32_t* overlap) {
  const auto& index = static_cast<const unisim::recorded::Recorded*>(recorded)->index;
  const int32_t shared = index.window_size() - index.window_step();
  if (index.window_step() <= 0 || shared < 0 || index.window_size() < 2) return 0;
  *size = index.window_size();
  *overlap = shared;
  return 1;
}

unisim_predictor* unisim_recorded_open(const char* path, char* message, size_t message_size) {
  using namespace unisim::recorded;
  say(message, message_size, "");
  try {
    auto recorded = std::make_unique<Recorded>();
    recorded->path = path;
    if (!recorded->reader.open(path) || !recorded->index.build(&recorded->reader)) {
      say(message, message_size, recorded->reader.problem());
      return nullptr;
    }
    if (!recorded->index.complete()) {
      say(message, message_size,
          recorded->path + ": this recording was cut off after " +
              std::to_string(recorded->index.record_count()) + " records (" +
              std::to_string(recorded->index.keyframes().size()) + " keyframes)");
    }
    fill_table(recorded.get());
    return recorded.release();
  } catch (const std::bad_alloc&) {
    say(message, message_size, std::string("not enough memory to read ") + path);
    return nullptr;
  } catch (const std::exception& error) {
    say(message, message_size, std::string(path) + ": " + error.what());
    return nullptr;
  }
}
