// SPDX-License-Identifier: MIT
// The struct_size rules: one place that copies structs between versions of the header.
#pragma once

#include <cstddef>
#include <cstring>

#include "unisim/places.h"
#include "unisim/unisim.h"

namespace unisim {

/// Where the struct of the first release ended; fields are only ever added behind it.
#define UNISIM_FIRST_SIZE(type, last_field) (offsetof(type, last_field) + sizeof(type::last_field))

template <class T>
struct FirstSize;
template <>
struct FirstSize<unisim_config> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_config, skeleton_capacity);
};
template <>
struct FirstSize<unisim_keyframe> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_keyframe, timestamp_ns);
};
template <>
struct FirstSize<unisim_two_view> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_two_view, center_sigma);
};
template <>
struct FirstSize<unisim_submap> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_submap, center_sigma);
};
template <>
struct FirstSize<unisim_submap_update> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_submap_update, center_sigma);
};
template <>
struct FirstSize<unisim_request> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_request, keyframe_ids);
};
template <>
struct FirstSize<unisim_budget> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_budget, max_iterations);
};
template <>
struct FirstSize<unisim_report> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_report, jump_log_scale);
};
template <>
struct FirstSize<unisim_pose> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_pose, segment);
};
template <>
struct FirstSize<unisim_submap_info> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_submap_info, scatter);
};
template <>
struct FirstSize<unisim_retired> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_retired, T);
};
template <>
struct FirstSize<unisim_loop_info> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_loop_info, residual);
};
template <>
struct FirstSize<unisim_session_info> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_session_info, arena_peak_bytes);
};
template <>
struct FirstSize<unisim_load_report> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_load_report, given);
};
template <>
struct FirstSize<unisim_distance> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_distance, common_sigma);
};
template <>
struct FirstSize<unisim_submap_unit> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_submap_unit, common_sigma);
};
template <>
struct FirstSize<unisim_scale> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_scale, lost);
};
template <>
struct FirstSize<unisim_places_config> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_places_config, same_place);
};
template <>
struct FirstSize<unisim_places_question> {
  static constexpr size_t kBytes = UNISIM_FIRST_SIZE(unisim_places_question, descriptor);
};

#undef UNISIM_FIRST_SIZE

/// No header will ever have a larger struct: such a size is memory that nobody has set.
inline constexpr size_t kLargestStruct = 65536;

/// Is this a size that the first or any later header may have?
template <class T>
bool is_size_of(size_t size) {
  return size >= FirstSize<T>::kBytes && size <= kLargestStruct;
}

/// struct_size, the first field of every versioned struct.
inline uint32_t struct_size_of(const void* user) {
  uint32_t size = 0;
  std::memcpy(&size, user, sizeof size);
  return size;
}

inline bool all_zero(const unsigned char* bytes, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    if (bytes[i] != 0) return false;
  }
  return true;
}

/// Copy the caller's struct over `ours`, which holds defaults.
/// @return UNISIM_OK, UNISIM_ERR_INVALID_ARGUMENT on NULL, UNISIM_ERR_ABI_MISMATCH
template <class T>
unisim_status read_struct(const T* user, T* ours) {
  if (user == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  const size_t size = struct_size_of(user);
  if (!is_size_of<T>(size)) return UNISIM_ERR_ABI_MISMATCH;
  const auto* bytes = reinterpret_cast<const unsigned char*>(user);
  if (size > sizeof(T) && !all_zero(bytes + sizeof(T), size - sizeof(T))) {
    return UNISIM_ERR_ABI_MISMATCH;
  }
  std::memcpy(ours, user, size < sizeof(T) ? size : sizeof(T));
  ours->struct_size = sizeof(T);
  return UNISIM_OK;
}

/// May results be written to the caller's struct?
template <class T>
unisim_status check_output(const T* user) {
  if (user == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  return is_size_of<T>(struct_size_of(user)) ? UNISIM_OK : UNISIM_ERR_ABI_MISMATCH;
}

/// Copy results to the caller's struct of `size` bytes, which check_output() has passed. A tail
/// that this library does not know is zeroed: to its reader zero means "as before".
template <class T>
void write_struct(T ours, size_t size, void* user) {
  ours.struct_size = static_cast<uint32_t>(size);
  std::memcpy(user, &ours, size < sizeof(T) ? size : sizeof(T));
  if (size > sizeof(T)) std::memset(static_cast<char*>(user) + sizeof(T), 0, size - sizeof(T));
}

}  // namespace unisim
