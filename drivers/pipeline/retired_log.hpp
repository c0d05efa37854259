// SPDX-License-Identifier: MIT
// What has left the window of a run, in the order it left: for the map file, so that a later run
// knows the poses of all keyframes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/mapfile/map_file.hpp"
#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/pose_book.hpp"
#include "drivers/pipeline/temporary_file.hpp"

namespace unisim::pipeline {

class RetiredLog : public Listener {
 public:
  /// @param folder on whose disk it lies, "" for memory
  explicit RetiredLog(const std::string& folder) : log_(folder) {}

  void on_retired(const unisim_retired& retired, const unisim_pose* pose) override;

  /// The part of a map file.
  mapfile::Bytes bytes() const;

  /// Tells listeners what had left when a map was saved, this log among them.
  /// @param bytes   of the part; empty: nothing had
  /// @param map     it is of, for messages  @param session that has it  @param keyframes of it
  /// Throws mapfile::Error where the part is none.
  static void tell(const mapfile::Bytes& bytes, const mapfile::MapFile& map,
                   const unisim_session* session, int32_t keyframes,
                   const std::vector<Listener*>& listeners);

 private:
  RecordFile<unisim_retired> log_;
};

}  // namespace unisim::pipeline
