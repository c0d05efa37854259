// SPDX-License-Identifier: MIT
// Layout of a prediction file: the structs are the bytes. README.md has the same in words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "unisim/unisim.h"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "prediction files are little-endian and are read and written without conversion"
#endif

namespace unisim::recorded {

constexpr std::array<unsigned char, 8> kMagic = {0x89, 'U', 'S', 'R', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxHeaderBytes = 65536;
constexpr std::uint32_t kMaxKeyBytes = 4096;
constexpr std::size_t kHeadBytes = 24;
constexpr std::int64_t kUnknownTime = INT64_MIN;  ///< timestamp_ns not known

enum class Kind : std::uint32_t {
  kFrame = 1,
  kKeyframe = 2,
  kPair = 3,
  kWindow = 4,
  kRevision = 5,
  kFramePose = 6,
  kInfo = 7,
  kEnd = 8,
  kWideWindow = 9,
  kPlace = 10
};

/// Start of the file; three texts (u32 length, bytes: creator, sequence, predictor), zeros to a
/// multiple of 8 less 4, and the CRC-32C of all that follow it.
struct FileHead {
  std::array<unsigned char, 8> magic;
  std::uint32_t version;
  std::uint32_t header_bytes;
  std::int32_t image_width;
  std::int32_t image_height;
  std::int32_t keyframe_count;
  std::uint32_t concurrent_windows;  ///< as of the predictor that was recorded: 0 or 1
};

/// Start of every record; `key_bytes` and `data_bytes` follow, both multiples of 8.
struct RecordHead {
  std::uint32_t kind;
  std::uint32_t key_bytes;
  std::uint64_t data_bytes;
  std::uint32_t data_crc;  ///< of the data
  std::uint32_t head_crc;  ///< of the 20 bytes above and the key
};

/// When an answer was given: after these calls of observe(), keyframe(), finish(). Where windows
/// were asked for beside the tracking its progress says nothing about them: then the frame is -1
/// and the keyframe the newest one that a window was asked for.
struct Moment {
  std::int64_t frame = -1;     ///< index of the frame observed last
  std::int32_t keyframe = -1;  ///< newest keyframe id
  std::int32_t finished = 0;   ///< 1 after finish()
};

struct FrameKey {
  std::int64_t index;
  std::int64_t timestamp_ns;
  double flow;
  double tracked;
  std::int32_t status;
  std::int32_t reason;  ///< UNISIM_REASON_*; 0 in files made before there were any
};

struct KeyframeKey {
  std::int64_t frame_index;
  std::int64_t timestamp_ns;
  std::int32_t id;
  std::int32_t reserved;
};

struct PairKey {
  Moment moment;
  std::int32_t status;
  std::int32_t i;
  std::int32_t j;
  std::int32_t reserved;
};

/// Followed by `count` ids as they were asked for.
struct WindowKey {
  Moment moment;
  std::int32_t status;
  std::int32_t count;
};

struct RevisionKey {
  Moment moment;
  std::int64_t token;
};

struct WideWindowKey {
  Moment moment;
};

/// What a keyframe looks like.
struct PlaceKey {
  Moment moment;
  std::int32_t status;
  std::int32_t id;
};

struct FramePoseKey {
  Moment moment;
  std::int32_t status;
  std::int32_t keyframe_id;
};

/// unisim_predictor_info at the end of the run.
struct InfoKey {
  double focal_px;
  double focal_sigma_px;
  double radial_k1;
  std::int64_t state_bytes;
  std::int32_t initialised;
  std::int32_t restarts;
  std::int32_t rotation_only;
  std::int32_t static_frames;
};

/// After it: the principal point from the middle of the image. Older files end before.
struct InfoCenter {
  double x_px;
  double y_px;
};

struct EndKey {
  std::int64_t record_count;  ///< records before this one
};

/// Data of an answered pair, before its two depth maps.
struct PairData {
  double focal_px;
  double center_sigma;
  unisim_sim3 T_i_j;
};

/// After the depth maps of a pair over a gap, or one with PairDoubt; others end there.
struct PairGap {
  std::int32_t gap;
  std::int32_t reserved;
};

/// After the gap of a pair whose scale is hardly known; others end there.
struct PairDoubt {
  double log_scale_sigma;
};

/// After the depth maps of a window whose unit is known in metres; others end there.
struct WindowUnit {
  double metres_per_unit;
  double sigma;
  double common_sigma;
};

/// Data of an answered window, before ids, poses and depth maps of its `count` views.
struct WindowData {
  double focal_px;
  double center_sigma;
  std::int64_t token;
  std::int32_t count;
  std::int32_t reserved;
};

/// Data of a revision, before poses and log ratios of its `count` views.
struct RevisionData {
  double center_sigma;
  std::int32_t count;
  std::int32_t scale_settled;  ///< 0 in files made before there was any
};

/// Data of a place, before its `dimension` int8 numbers.
struct PlaceData {
  std::int32_t dimension;
  std::int32_t image_width;
  std::int32_t image_height;
  std::int32_t reserved;
};

/// Before height*width float32 depths and, where there is confidence, as many float32 of it.
struct DepthHead {
  std::int32_t width;
  std::int32_t height;
  std::int32_t has_confidence;  ///< 0: the pointer was NULL
  std::int32_t reserved;
};

static_assert(sizeof(FileHead) == 32 && sizeof(RecordHead) == kHeadBytes);
static_assert(sizeof(Moment) == 16 && sizeof(FrameKey) == 40 && sizeof(KeyframeKey) == 24);
static_assert(sizeof(PairKey) == 32 && sizeof(WindowKey) == 24 && sizeof(RevisionKey) == 24);
static_assert(sizeof(WideWindowKey) == 16 && sizeof(FramePoseKey) == 24 && sizeof(InfoKey) == 48 &&
              sizeof(EndKey) == 8);
static_assert(sizeof(unisim_sim3) == 64 && sizeof(PairData) == 80 && sizeof(WindowData) == 32);
static_assert(sizeof(WindowUnit) == 24);
static_assert(sizeof(PlaceKey) == 24 && sizeof(PlaceData) == 16);
static_assert(sizeof(RevisionData) == 16 && sizeof(DepthHead) == 16);

}  // namespace unisim::recorded
