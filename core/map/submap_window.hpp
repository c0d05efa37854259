// SPDX-License-Identifier: MIT
// Which windows of keyframes want a multi-view prediction.
#pragma once

#include <cstdint>

#include "core/base/fixed_vector.hpp"
#include "core/snapshot/archive.hpp"

namespace unisim {

/// Keyframes first .. first + count - 1.
struct Window {
  int32_t first = 0;
  int32_t count = 0;
  int32_t last() const { return first + count - 1; }
  bool holds(int32_t keyframe) const { return keyframe >= first && keyframe <= last(); }
};

/// Cuts the stream of keyframes into windows of `size` that share `overlap` with the window before,
/// and keeps those that are not answered yet, oldest first.
class WindowSchedule {
 public:
  WindowSchedule() = default;
  /// @param max_windows cut in all; with `endless` open at a time, the oldest of them gives way
  /// @param first_id of the keyframes
  WindowSchedule(Arena& arena, int32_t size, int32_t overlap, int32_t max_windows, bool endless,
                 int32_t first_id)
      : open_(arena, max_windows),
        size_(size),
        overlap_(overlap),
        endless_(endless),
        next_first_(first_id),
        covered_(first_id) {}

  /// A keyframe has arrived; `keyframes` are there now. false: it completed a window and there is
  /// no room; `skipped` will not be asked for.
  bool keyframe_added(int32_t keyframes, Window* skipped);

  /// Cut a shorter window from the keyframes no window covers. false: fewer than two are left over.
  bool close(int32_t keyframes);

  /// Oldest open window whose last keyframe is at most `settled`; null when there is none.
  const Window* oldest(int32_t settled) const;
  /// Open window with exactly these ends, else the oldest that holds both; -1 when there is none.
  int32_t find(int32_t first, int32_t last) const;
  const Window& at(int32_t index) const { return open_[index]; }
  /// Give up the oldest open window that begins before a keyframe. false: there is none.
  bool drop_before(int32_t keyframe, Window* dropped);
  /// The window is answered.
  void remove(int32_t index);

  /// Save or load; `keyframes` are there.
  void visit(Archive* archive, int32_t keyframes);

 private:
  bool append(const Window& window, Window* skipped);

  FixedVector<Window> open_;
  int32_t size_ = 0;
  int32_t overlap_ = 0;
  bool endless_ = false;
  int32_t next_first_ = 0;  ///< first keyframe of the next full window
  int32_t covered_ = 0;     ///< keyframes before this one lie in a window
  int32_t cut_ = 0;         ///< windows cut so far
};

}  // namespace unisim
