// SPDX-License-Identifier: MIT
// The map of a run as one file: what the session knows and what the predictor knows.
#pragma once

#include <cstdint>
#include <string>

#include "drivers/mapfile/sections.hpp"
#include "drivers/predictor.h"
#include "unisim/unisim.h"

namespace unisim::mapfile {

/// What a map says of itself.
struct About {
  std::string program;    ///< that wrote it, and its version
  std::string predictor;  ///< whose map it is
  std::string sequence;   ///< of the last run
  int32_t image_width = 0;
  int32_t image_height = 0;
  int32_t keyframes = 0;  ///< of all runs so far
};

/// Writes the map of a run that has ended, see write_sections(). Throws Error; then the file is as
/// it was.
/// @param about all but predictor and keyframes
/// @param left    what has left the session's window, as its host keeps it; empty: nothing
/// @param windows what the predictor may measure again, as the host keeps it; empty: nothing
void save_map(const std::string& path, About about, const unisim_session* session,
              unisim_predictor* predictor, Bytes left, Bytes windows);

/// A map in memory, until it has been handed on.
class MapFile {
 public:
  /// Reads and checks the file as such. Throws Error.
  explicit MapFile(const std::string& path);

  const About& about() const { return about_; }
  const std::string& path() const { return path_; }
  /// What had left the session's window; empty: nothing, or it was not kept.
  Bytes left() const;
  /// What the predictor may measure again; empty: nothing, or it was not kept.
  Bytes windows() const;
  /// Hands the map to a session without keyframes and to a predictor before its first frame, and
  /// forgets it. Throws Error; then neither is of use.
  void hand_over(unisim_session* session, unisim_predictor* predictor);

 private:
  const Bytes* find(const char* name) const;
  Bytes optional(const char* name) const;
  const Bytes& part(const char* name) const;
  int32_t load_session(unisim_session* session) const;
  int32_t load_predictor(unisim_predictor* predictor) const;
  [[noreturn]] void fail(const std::string& why) const;

  std::string path_;
  std::vector<Section> sections_;
  About about_;
};

}  // namespace unisim::mapfile
