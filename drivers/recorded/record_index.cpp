// SPDX-License-Identifier: MIT
// What a prediction file holds and when each answer was given.
#include "drivers/recorded/record_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace unisim::recorded {
namespace {

/// Copies the fixed part of a key. @return false when the key is shorter
template <class T>
bool read_key(const RecordRef& record, const AlignedBytes& key, T* out) {
  if (record.head.key_bytes < sizeof(T)) return false;
  std::memcpy(out, key.data(), sizeof(T));
  return true;
}

bool answer_status(std::int32_t status) {
  return status == UNISIM_PREDICTION_OK || status == UNISIM_PREDICTION_PENDING ||
         status == UNISIM_PREDICTION_REJECTED;
}

constexpr const char* kShort = "record too short for its kind";
constexpr const char* kStatus = "record with an unknown status";

}  // namespace

Question pair_question(std::int32_t i, std::int32_t j) {
  return {static_cast<std::int64_t>(Kind::kPair), i, j};
}

Question window_question(const std::int32_t* ids, std::int32_t count) {
  Question question = {static_cast<std::int64_t>(Kind::kWindow)};
  question.insert(question.end(), ids, ids + count);
  return question;
}

Question frame_pose_question(std::int64_t frame) {
  return {static_cast<std::int64_t>(Kind::kFramePose), frame};
}

Question place_question(std::int32_t id) { return {static_cast<std::int64_t>(Kind::kPlace), id}; }

bool has_come(const Moment& moment, const Moment& now) {
  return moment.keyframe <= now.keyframe && moment.frame <= now.frame &&
         moment.finished <= now.finished;
}

RecordedAnswer* due_answer(RecordedAnswers* answers, const Moment& now) {
  RecordedAnswer* last_given = nullptr;
  for (RecordedAnswer& answer : *answers) {
    if (answer.status == UNISIM_PREDICTION_PENDING) continue;
    if (answer.given) {
      last_given = &answer;
    } else if (has_come(answer.moment, now)) {
      return &answer;
    } else {
      break;
    }
  }
  return last_given;
}

bool RecordIndex::build(RecordReader* reader) {
  RecordRef record;
  AlignedBytes key;
  for (;;) {
    const RecordReader::Step step = reader->next(&record, &key);
    if (step == RecordReader::Step::kDamaged) return false;
    if (step != RecordReader::Step::kRecord) return true;
    if (complete_) return reader->damaged(record.offset, "records after the end: file damaged");
    const char* problem = add(record, key);
    if (problem != nullptr) return reader->damaged(record.offset, problem);
    ++record_count_;
  }
}

const char* RecordIndex::add(const RecordRef& record, const AlignedBytes& key) {
  switch (static_cast<Kind>(record.head.kind)) {
    case Kind::kFrame:
      return add_frame(record, key);
    case Kind::kKeyframe:
      return add_keyframe(record, key);
    case Kind::kPair:
      return add_pair(record, key);
    case Kind::kWindow:
      return add_window(record, key);
    case Kind::kRevision:
      return add_revision(record, key);
    case Kind::kWideWindow:
      return add_wide_window(record, key);
    case Kind::kFramePose:
      return add_frame_pose(record, key);
    case Kind::kPlace:
      return add_place(record, key);
    case Kind::kInfo:
      return set_info(record, key);
    case Kind::kEnd:
      return set_end(record, key);
  }
  return nullptr;  // a kind that a later program of the same version may add
}

const char* RecordIndex::add_frame(const RecordRef& record, const AlignedBytes& key) {
  FrameKey frame{};
  if (!read_key(record, key, &frame)) return kShort;
  if (!answer_status(frame.status)) return kStatus;
  if (!std::isfinite(frame.flow) || !std::isfinite(frame.tracked)) {
    return "frame whose motion is not a number";
  }
  if (!frames_.empty() && frame.index <= frames_.back().index) return "frames out of order";
  frames_.push_back({frame.index, frame.timestamp_ns, frame.flow, frame.tracked, frame.status,
                     frame.reason, record});
  return nullptr;
}

const char* RecordIndex::add_keyframe(const RecordRef& record, const AlignedBytes& key) {
  KeyframeKey keyframe{};
  if (!read_key(record, key, &keyframe)) return kShort;
  const bool next = keyframe.id == static_cast<std::int64_t>(keyframes_.size());
  if (!next || (!keyframes_.empty() && keyframe.frame_index <= keyframes_.back().index)) {
    return "keyframes out of order";
  }
  RecordedFrame frame;
  frame.index = keyframe.frame_index;
  frame.timestamp_ns = keyframe.timestamp_ns;
  keyframes_.push_back(frame);
  return nullptr;
}

const char* RecordIndex::add_pair(const RecordRef& record, const AlignedBytes& key) {
  PairKey pair{};
  if (!read_key(record, key, &pair)) return kShort;
  if (!answer_status(pair.status)) return kStatus;
  answers_[pair_question(pair.i, pair.j)].push_back({pair.moment, pair.status, -1, false, record});
  return nullptr;
}

const char* RecordIndex::add_window(const RecordRef& record, const AlignedBytes& key) {
  WindowKey window{};
  if (!read_key(record, key, &window)) return kShort;
  if (!answer_status(window.status)) return kStatus;
  if (window.count < 1 || window.count > UNISIM_MAX_VIEWS) return "window of impossible size";
  std::int32_t ids[UNISIM_MAX_VIEWS];
  const std::size_t id_bytes = static_cast<std::size_t>(window.count) * sizeof ids[0];
  if (record.head.key_bytes < sizeof window + id_bytes) return kShort;
  std::memcpy(ids, key.data() + sizeof window, id_bytes);
  // Others were asked for to close a loop.
  const bool neighbours = ids[window.count - 1] - ids[0] == window.count - 1;
  if (neighbours && window_size_ == 0) {
    window_size_ = window.count;
    window_first_ = ids[0];
  } else if (neighbours && window_step_ == 0) {
    window_step_ = ids[0] - window_first_;
  }
  answers_[window_question(ids, window.count)].push_back(
      {window.moment, window.status, -1, false, record});
  return nullptr;
}

const char* RecordIndex::add_revision(const RecordRef& record, const AlignedBytes& key) {
  RevisionKey revision{};
  if (!read_key(record, key, &revision)) return kShort;
  revisions_.push_back({revision.moment, revision.token, record});
  return nullptr;
}

const char* RecordIndex::add_wide_window(const RecordRef& record, const AlignedBytes& key) {
  WideWindowKey window{};
  if (!read_key(record, key, &window)) return kShort;
  wide_windows_.push_back({window.moment, record});
  return nullptr;
}

const char* RecordIndex::add_place(const RecordRef& record, const AlignedBytes& key) {
  PlaceKey place{};
  if (!read_key(record, key, &place)) return kShort;
  if (!answer_status(place.status)) return kStatus;
  answers_[place_question(place.id)].push_back(
      {place.moment, place.status, place.id, false, record});
  has_places_ = true;
  return nullptr;
}

const char* RecordIndex::add_frame_pose(const RecordRef& record, const AlignedBytes& key) {
  FramePoseKey pose{};
  if (!read_key(record, key, &pose)) return kShort;
  if (!answer_status(pose.status)) return kStatus;
  answers_[frame_pose_question(pose.moment.frame)].push_back(
      {pose.moment, pose.status, pose.keyframe_id, false, record});
  has_frame_poses_ = true;
  return nullptr;
}

const char* RecordIndex::set_info(const RecordRef& record, const AlignedBytes& key) {
  InfoKey info{};
  if (!read_key(record, key, &info)) return kShort;
  if (!std::isfinite(info.focal_px) || !std::isfinite(info.focal_sigma_px) ||
      !std::isfinite(info.radial_k1)) {
    return "focal length or distortion is not a number";
  }
  info_ = {};
  info_.focal_px = info.focal_px;
  info_.focal_sigma_px = info.focal_sigma_px;
  info_.radial_k1 = info.radial_k1;
  info_.state_bytes = info.state_bytes;
  info_.initialised = info.initialised;
  info_.restarts = info.restarts;
  info_.rotation_only = info.rotation_only;
  info_.static_frames = info.static_frames;
  if (record.head.key_bytes < sizeof(InfoKey) + sizeof(InfoCenter)) return nullptr;
  InfoCenter center{};
  std::memcpy(&center, key.data() + sizeof(InfoKey), sizeof center);
  if (!std::isfinite(center.x_px) || !std::isfinite(center.y_px)) {
    return "principal point is not a number";
  }
  info_.center_x_px = center.x_px;
  info_.center_y_px = center.y_px;
  return nullptr;
}

const char* RecordIndex::set_end(const RecordRef& record, const AlignedBytes& key) {
  EndKey end{};
  if (!read_key(record, key, &end)) return kShort;
  if (end.record_count != record_count_) return "records are missing: file damaged";
  complete_ = true;
  return nullptr;
}

const RecordedFrame* RecordIndex::find(const std::vector<RecordedFrame>& frames,
                                       std::int64_t index) {
  const auto before = [](const RecordedFrame& frame, std::int64_t at) { return frame.index < at; };
  const auto found = std::lower_bound(frames.begin(), frames.end(), index, before);
  return found != frames.end() && found->index == index ? &*found : nullptr;
}

RecordedAnswers* RecordIndex::find_answers(const Question& question) {
  const auto found = answers_.find(question);
  return found != answers_.end() ? &found->second : nullptr;
}

std::size_t RecordIndex::bytes() const {
  std::size_t bytes = (frames_.capacity() + keyframes_.capacity()) * sizeof(RecordedFrame) +
                      revisions_.capacity() * sizeof(RecordedRevision) +
                      wide_windows_.capacity() * sizeof(RecordedWideWindow);
  for (const auto& [question, answers] : answers_) {
    bytes += sizeof(Question) + question.capacity() * sizeof(std::int64_t) +
             sizeof(RecordedAnswers) + answers.capacity() * sizeof(RecordedAnswer);
  }
  return bytes;
}

}  // namespace unisim::recorded
