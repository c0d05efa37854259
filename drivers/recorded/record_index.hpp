// SPDX-License-Identifier: MIT
// What a prediction file holds and when each answer was given: a few words per record.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "drivers/predictor.h"
#include "drivers/recorded/record_format.hpp"
#include "drivers/recorded/record_reader.hpp"

namespace unisim::recorded {

/// A frame or keyframe of the recording.
struct RecordedFrame {
  std::int64_t index = 0;
  std::int64_t timestamp_ns = kUnknownTime;
  double flow = -1.0;
  double tracked = -1.0;
  std::int32_t status = UNISIM_PREDICTION_OK;
  std::int32_t reason = UNISIM_REASON_NONE;
  RecordRef record;
};

/// One answer to a question.
struct RecordedAnswer {
  Moment moment;
  std::int32_t status = UNISIM_PREDICTION_OK;
  std::int32_t keyframe_id = -1;  ///< of a frame pose
  bool given = false;
  RecordRef record;
};

/// The answers to one question, in the order they were given.
using RecordedAnswers = std::vector<RecordedAnswer>;

/// What was asked: the kind and the keyframe ids, or the frame index.
using Question = std::vector<std::int64_t>;
Question pair_question(std::int32_t i, std::int32_t j);
Question window_question(const std::int32_t* ids, std::int32_t count);
Question frame_pose_question(std::int64_t frame);
Question place_question(std::int32_t id);

bool has_come(const Moment& moment, const Moment& now);
/// The first answer not given yet whose moment has come, else the one given last; NULL: none.
RecordedAnswer* due_answer(RecordedAnswers* answers, const Moment& now);

struct RecordedRevision {
  Moment moment;
  std::int64_t token = 0;
  RecordRef record;
};

struct RecordedWideWindow {
  Moment moment;
  RecordRef record;
};

class RecordIndex {
 public:
  /// Walks through an opened file. @return false: reader->problem() says why
  bool build(RecordReader* reader);

  /// NULL when the file has no such frame. Both look-ups take O(log n).
  const RecordedFrame* find_frame(std::int64_t index) const { return find(frames_, index); }
  const RecordedFrame* find_keyframe(std::int64_t index) const { return find(keyframes_, index); }

  /// All of them, ascending by frame index; keyframe k is keyframes()[k].
  const std::vector<RecordedFrame>& frames() const { return frames_; }
  const std::vector<RecordedFrame>& keyframes() const { return keyframes_; }

  /// Answers to a question; NULL when the file does not know it.
  RecordedAnswers* find_answers(const Question& question);

  /// Keyframes of the first window of neighbours, and from its first keyframe to that of the next;
  /// 0: not known.
  std::int32_t window_size() const { return window_size_; }
  std::int32_t window_step() const { return window_step_; }

  const std::vector<RecordedRevision>& revisions() const { return revisions_; }
  const std::vector<RecordedWideWindow>& wide_windows() const { return wide_windows_; }
  const unisim_predictor_info& info() const { return info_; }
  bool has_frame_poses() const { return has_frame_poses_; }
  bool has_places() const { return has_places_; }
  bool complete() const { return complete_; }
  std::int64_t record_count() const { return record_count_; }
  std::size_t bytes() const;

 private:
  static const RecordedFrame* find(const std::vector<RecordedFrame>& frames, std::int64_t index);
  const char* add(const RecordRef& record, const AlignedBytes& key);
  const char* add_frame(const RecordRef& record, const AlignedBytes& key);
  const char* add_keyframe(const RecordRef& record, const AlignedBytes& key);
  const char* add_pair(const RecordRef& record, const AlignedBytes& key);
  const char* add_window(const RecordRef& record, const AlignedBytes& key);
  const char* add_revision(const RecordRef& record, const AlignedBytes& key);
  const char* add_wide_window(const RecordRef& record, const AlignedBytes& key);
  const char* add_place(const RecordRef& record, const AlignedBytes& key);
  const char* add_frame_pose(const RecordRef& record, const AlignedBytes& key);
  const char* set_info(const RecordRef& record, const AlignedBytes& key);
  const char* set_end(const RecordRef& record, const AlignedBytes& key);

  std::vector<RecordedFrame> frames_;
  std::vector<RecordedFrame> keyframes_;
  std::map<Question, RecordedAnswers> answers_;
  std::vector<RecordedRevision> revisions_;
  std::vector<RecordedWideWindow> wide_windows_;
  unisim_predictor_info info_{};
  std::int32_t window_size_ = 0;
  std::int32_t window_first_ = 0;  // its first keyframe
  std::int32_t window_step_ = 0;
  bool has_frame_poses_ = false;
  bool has_places_ = false;
  bool complete_ = false;
  std::int64_t record_count_ = 0;
};

}  // namespace unisim::recorded
