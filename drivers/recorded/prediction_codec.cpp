// SPDX-License-Identifier: MIT
// Predictions to and from the data part of a record.
#include "drivers/recorded/prediction_codec.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace unisim::recorded {
namespace {

bool has_pixels(const unisim_depth_map& map) {
  return map.depth != nullptr && map.width > 0 && map.height > 0;
}

std::size_t pixel_count(std::int32_t width, std::int32_t height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

void encode_depth(const unisim_depth_map& map, RecordBytes* out) {
  DepthHead head{};
  if (!has_pixels(map)) {
    out->put(head);
    return;
  }
  const std::size_t count = pixel_count(map.width, map.height);
  head.width = map.width;
  head.height = map.height;
  head.has_confidence = map.confidence != nullptr ? 1 : 0;
  out->put(head);
  out->put_array(map.depth, count);
  if (map.confidence != nullptr) out->put_array(map.confidence, count);
  out->pad();
}

bool finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double value) { return std::isfinite(value); });
}

bool finite(const unisim_sim3& pose) {
  return finite(pose.q, 4) && finite(pose.t, 3) && std::isfinite(pose.s);
}

/// Takes arrays one after the other out of aligned bytes.
class Cursor {
 public:
  Cursor(const unsigned char* data, std::size_t size) : data_(data), size_(size) {}

  /// `count` values, padded to 8 bytes; NULL when there are not as many.
  template <class T>
  const T* take(std::size_t count) {
    if (count > left() / sizeof(T)) return nullptr;
    const auto* values = reinterpret_cast<const T*>(data_ + at_);
    at_ += std::min((count * sizeof(T) + 7) / 8 * 8, left());
    return values;
  }

  std::size_t left() const { return size_ - at_; }  ///< bytes not taken yet

 private:
  const unsigned char* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

Decoded fail(Decoded how, const char* what, std::string* problem) {
  *problem = what;
  return how;
}

Decoded decode_depth(Cursor* cursor, unisim_depth_map* out, std::string* problem) {
  *out = unisim_depth_map{};
  const DepthHead* head = cursor->take<DepthHead>(1);
  if (head == nullptr) return fail(Decoded::kMalformed, "depth map missing", problem);
  if (head->width == 0 && head->height == 0) return Decoded::kOk;
  constexpr std::int32_t kLargest = 65536;
  const bool possible = head->width > 0 && head->width <= kLargest && head->height > 0 &&
                        head->height <= kLargest &&
                        (head->has_confidence == 0 || head->has_confidence == 1);
  if (!possible) return fail(Decoded::kMalformed, "depth map of impossible size", problem);
  // Where size_t has 32 bits the product may wrap: more than the record has is refused before.
  const std::uint64_t values = std::uint64_t{static_cast<std::uint32_t>(head->width)} *
                               static_cast<std::uint32_t>(head->height) *
                               (head->has_confidence != 0 ? 2U : 1U);
  const bool fits = values <= cursor->left() / sizeof(float);
  const std::size_t count = fits ? pixel_count(head->width, head->height) : 0;
  const float* pixels = fits ? cursor->take<float>(static_cast<std::size_t>(values)) : nullptr;
  if (pixels == nullptr) {
    return fail(Decoded::kMalformed, "depth map larger than its record", problem);
  }
  out->width = head->width;
  out->height = head->height;
  out->depth = pixels;
  if (head->has_confidence == 0) return Decoded::kOk;
  out->confidence = pixels + count;
  const bool numbers = std::all_of(out->confidence, out->confidence + count,
                                   [](float value) { return std::isfinite(value); });
  return numbers ? Decoded::kOk : fail(Decoded::kNotFinite, "confidence is not a number", problem);
}

/// One map per view; the worst answer counts.
Decoded decode_depths(Cursor* cursor, std::size_t count, DecodedArrays* arrays,
                      std::string* problem) {
  arrays->depth.resize(count);
  Decoded worst = Decoded::kOk;
  for (unisim_depth_map& map : arrays->depth) {
    const Decoded decoded = decode_depth(cursor, &map, problem);
    if (decoded == Decoded::kMalformed) return decoded;
    if (decoded != Decoded::kOk) worst = decoded;
  }
  return worst;
}

bool possible_count(std::int32_t count) { return count >= 1 && count <= UNISIM_MAX_VIEWS; }

bool finite(const unisim_sim3* poses, std::size_t count) {
  return std::all_of(poses, poses + count, [](const unisim_sim3& pose) { return finite(pose); });
}

}  // namespace

void encode_pair(const unisim_pair_prediction& pair, RecordBytes* out) {
  out->put(PairData{pair.focal_px, pair.center_sigma, pair.T_i_j});
  encode_depth(pair.depth_i, out);
  encode_depth(pair.depth_j, out);
  const bool doubtful = pair.log_scale_sigma > 0.0;
  if (pair.gap != 0 || doubtful) out->put(PairGap{pair.gap, 0});
  if (doubtful) out->put(PairDoubt{pair.log_scale_sigma});
}

void encode_window(const unisim_window_prediction& window, RecordBytes* out) {
  const auto count = static_cast<std::size_t>(window.count);
  out->put(WindowData{window.focal_px, window.center_sigma, window.token, window.count, 0});
  out->put_array(window.keyframe_ids, count);
  out->pad();
  out->put_array(window.T_window_kf, count);
  for (std::size_t view = 0; view < count; ++view) encode_depth(window.depth[view], out);
  if (window.metres_per_unit > 0.0) {
    out->put(WindowUnit{window.metres_per_unit, window.metres_sigma, window.metres_common_sigma});
  }
}

void encode_revision(const unisim_window_revision& revision, RecordBytes* out) {
  const auto count = static_cast<std::size_t>(revision.count);
  out->put(RevisionData{revision.center_sigma, revision.count, revision.scale_settled});
  out->put_array(revision.T_window_kf, count);
  out->put_array(revision.log_depth_ratio, count);
}

Decoded decode_pair(std::size_t size, DecodedArrays* arrays, unisim_pair_prediction* out,
                    std::string* problem) {
  Cursor cursor(arrays->data.data(), size);
  const PairData* pair = cursor.take<PairData>(1);
  if (pair == nullptr) return fail(Decoded::kMalformed, "pair too short", problem);
  const Decoded depths = decode_depths(&cursor, 2, arrays, problem);
  if (depths != Decoded::kOk) return depths;
  const PairGap* gap = cursor.take<PairGap>(1);
  const PairDoubt* doubt = gap != nullptr ? cursor.take<PairDoubt>(1) : nullptr;
  const double numbers[] = {pair->focal_px, pair->center_sigma,
                            doubt != nullptr ? doubt->log_scale_sigma : 0.0};
  if (!finite(numbers, 3) || !finite(pair->T_i_j)) {
    return fail(Decoded::kNotFinite, "pose, focal length or sigma is not a number", problem);
  }
  *out = {pair->T_i_j,
          arrays->depth[0],
          arrays->depth[1],
          pair->focal_px,
          pair->center_sigma,
          gap != nullptr ? gap->gap : 0,
          0,
          numbers[2]};
  return Decoded::kOk;
}

Decoded decode_window(std::size_t size, DecodedArrays* arrays, unisim_window_prediction* out,
                      std::string* problem) {
  Cursor cursor(arrays->data.data(), size);
  const WindowData* window = cursor.take<WindowData>(1);
  if (window == nullptr || !possible_count(window->count)) {
    return fail(Decoded::kMalformed, "window of impossible size", problem);
  }
  const auto count = static_cast<std::size_t>(window->count);
  const auto* ids = cursor.take<std::int32_t>(count);
  const auto* poses = cursor.take<unisim_sim3>(count);
  if (poses == nullptr) return fail(Decoded::kMalformed, "window too short", problem);
  const Decoded depths = decode_depths(&cursor, count, arrays, problem);
  if (depths != Decoded::kOk) return depths;
  const double numbers[] = {window->focal_px, window->center_sigma};
  if (!finite(numbers, 2) || !finite(poses, count)) {
    return fail(Decoded::kNotFinite, "pose, focal length or sigma is not a number", problem);
  }
  const WindowUnit* unit = cursor.take<WindowUnit>(1);
  const WindowUnit known = unit != nullptr ? *unit : WindowUnit{};
  const double lengths[] = {known.metres_per_unit, known.sigma, known.common_sigma};
  if (!finite(lengths, 3)) return fail(Decoded::kNotFinite, "unit is not a number", problem);
  *out = {window->count,        ids,           poses,   arrays->depth.data(),  window->focal_px,
          window->center_sigma, window->token, nullptr, known.metres_per_unit, known.sigma,
          known.common_sigma};
  return Decoded::kOk;
}

Decoded decode_revision(std::size_t size, DecodedArrays* arrays, unisim_window_revision* out,
                        std::string* problem) {
  Cursor cursor(arrays->data.data(), size);
  const RevisionData* revision = cursor.take<RevisionData>(1);
  if (revision == nullptr || !possible_count(revision->count)) {
    return fail(Decoded::kMalformed, "revision of impossible size", problem);
  }
  const auto count = static_cast<std::size_t>(revision->count);
  const auto* poses = cursor.take<unisim_sim3>(count);
  const auto* ratios = cursor.take<double>(count);
  if (poses == nullptr || ratios == nullptr) {
    return fail(Decoded::kMalformed, "revision too short", problem);
  }
  if (!std::isfinite(revision->center_sigma) || !finite(poses, count) || !finite(ratios, count)) {
    return fail(Decoded::kNotFinite, "pose, ratio or sigma is not a number", problem);
  }
  out->count = revision->count;
  out->T_window_kf = poses;
  out->log_depth_ratio = ratios;
  out->center_sigma = revision->center_sigma;
  out->scale_settled = revision->scale_settled;
  return Decoded::kOk;
}

void encode_place(const unisim_place_descriptor& place, RecordBytes* out) {
  out->put(PlaceData{place.dimension, place.image_width, place.image_height, 0});
  out->put_array(place.values, static_cast<std::size_t>(place.dimension));
}

Decoded decode_place(std::size_t size, DecodedArrays* arrays, unisim_place_descriptor* out,
                     std::string* problem) {
  PlaceData place{};
  if (size >= sizeof place) std::memcpy(&place, arrays->data.data(), sizeof place);
  if (place.dimension < 1 || static_cast<std::size_t>(place.dimension) > size - sizeof place) {
    *problem = "descriptor of impossible size";
    return Decoded::kMalformed;
  }
  *out = {reinterpret_cast<const std::int8_t*>(arrays->data.data()) + sizeof place, place.dimension,
          place.image_width, place.image_height, 0};
  return Decoded::kOk;
}

Decoded decode_pose(std::size_t size, const AlignedBytes& data, unisim_sim3* out) {
  if (size < sizeof *out) return Decoded::kMalformed;
  std::memcpy(out, data.data(), sizeof *out);
  return finite(*out) ? Decoded::kOk : Decoded::kNotFinite;
}

}  // namespace unisim::recorded
