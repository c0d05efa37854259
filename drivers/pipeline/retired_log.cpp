// SPDX-License-Identifier: MIT
// What has left the window of a run, in the order it left.
#include "drivers/pipeline/retired_log.hpp"

#include <cmath>
#include <set>

#include "drivers/common/archive.hpp"
#include "drivers/mapfile/byte_stream.hpp"

namespace unisim::pipeline {
namespace {

constexpr int32_t kMostSubmap = 1 << 30;
constexpr int32_t kMostConfidence = 3;

void archive(drivers::Archive* io, int32_t keyframes, unisim_retired* one) {
  io->number(one->kind, UNISIM_RETIRED_KEYFRAME, UNISIM_RETIRED_SUBMAP);
  io->number(one->keyframe_id, -1, keyframes - 1);
  io->number(one->submap_id, 0, kMostSubmap);
  io->number(one->anchor_id, -1, kMostSubmap);
  io->number(one->confidence, 0, kMostConfidence);
  io->number(one->segment, -1, kMostSubmap);
  io->number(one->timestamp_ns);
  double length = 0.0;
  for (double& value : one->T.q) {
    io->number(value);
    length += value * value;
  }
  for (double& value : one->T.t) io->number(value, -1e300, 1e300);
  io->number(one->T.s, 1e-300, 1e300);
  io->require(std::abs(length - 1.0) < 1e-6, "a rotation is none");
  const bool is_keyframe = one->kind == UNISIM_RETIRED_KEYFRAME;
  io->require((one->keyframe_id >= 0) == is_keyframe && (one->anchor_id >= 0) != is_keyframe,
              "what has left is neither keyframe nor submap");
}

/// A submap leaves once, and hangs on one that is there then: following anchors ends somewhere.
void check_order(const drivers::Archive& io, const unisim_retired& one, std::set<int32_t>* left) {
  if (one.kind != UNISIM_RETIRED_SUBMAP) return;
  io.require(left->insert(one.submap_id).second && left->count(one.anchor_id) == 0,
             "a submap hangs on one that had left before");
}

std::vector<unisim_retired> read(const mapfile::Bytes& bytes, int32_t keyframes) {
  mapfile::ByteSource rest{bytes};
  drivers::Archive io(mapfile::take_bytes, &rest);
  io.part("part left");
  std::vector<unisim_retired> all;
  std::set<int32_t> left;
  while (rest.at < bytes.size()) {
    unisim_retired one{};
    one.struct_size = sizeof one;
    archive(&io, keyframes, &one);
    check_order(io, one, &left);
    all.push_back(one);
  }
  return all;
}

}  // namespace

void RetiredLog::on_retired(const unisim_retired& retired, const unisim_pose* /*pose*/) {
  log_.append(retired);
}

mapfile::Bytes RetiredLog::bytes() const {
  mapfile::Bytes bytes;
  drivers::Archive io(mapfile::append_bytes, &bytes);
  for (int64_t k = 0; k < log_.size(); ++k) {
    unisim_retired one = log_.get(k);
    archive(&io, 0, &one);
  }
  return bytes;
}

void RetiredLog::tell(const mapfile::Bytes& bytes, const mapfile::MapFile& map,
                      const unisim_session* session, int32_t keyframes,
                      const std::vector<Listener*>& listeners) {
  std::vector<unisim_retired> all;
  try {
    all = read(bytes, keyframes);
  } catch (const drivers::ArchiveError& error) {
    throw mapfile::Error(mapfile::Error::Kind::kInput, map.path() + ": " + error.what());
  }
  PoseBook book;
  for (const unisim_retired& one : all) book.take(one);
  for (const unisim_retired& one : all) {
    unisim_pose pose{};
    pose.struct_size = sizeof pose;
    pose.keyframe_id = one.keyframe_id;
    pose.timestamp_ns = one.timestamp_ns;
    pose.confidence = one.confidence;
    pose.submap_id = one.submap_id;
    pose.segment = one.segment;
    const bool posed = one.kind == UNISIM_RETIRED_KEYFRAME &&
                       book.find(session, one.keyframe_id, &pose.T_world_kf);
    for (Listener* listener : listeners) listener->on_retired(one, posed ? &pose : nullptr);
  }
}

}  // namespace unisim::pipeline
