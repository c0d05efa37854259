// SPDX-License-Identifier: MIT
// Results of a run that only looks for frames in a map: --localise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/pipeline/listener.hpp"
#include "drivers/pipeline/pipeline.hpp"
#include "drivers/pipeline/temporary_file.hpp"
#include "tools/eval/trajectory.hpp"
#include "tools/replay/options.hpp"
#include "tools/replay/output_folder.hpp"
#include "tools/replay/scores.hpp"

namespace unisim::replay {

class LocalisedFrames : public pipeline::Listener {
 public:
  explicit LocalisedFrames(const Options& options)
      : options_(options),
        folder_(options.out, {"trajectory.tum", "localised.csv", "summary.json"}, options.force),
        frames_(options.out) {}

  void on_located(const pipeline::LocatedFrame& frame) override { frames_.append(frame); }

  /// Writes what the run gave, says how many frames were found. @return exit code of what was found
  /// and written
  int write(const pipeline::Result& result, const eval::Trajectory& truth,
            const std::string& format);

 private:
  struct Counts {
    int64_t frames = 0;
    int64_t followed = 0;
    int64_t anew = 0;
    int64_t found() const { return followed + anew; }
  };
  void write_files(const pipeline::Result& result, const Scores& scores,
                   const std::vector<unisim_stamped_pose>& poses, const std::string& format);
  bool take_metres(const std::vector<pipeline::Metre>& metres);
  std::string table() const;
  std::string text(const pipeline::Result& result, const Scores& scores) const;

  const Options& options_;
  OutputFolder folder_;
  pipeline::RecordFile<pipeline::LocatedFrame> frames_;
  Counts counts_;
  std::optional<SegmentScale> metre_;  // of the map; not set: relative
};

}  // namespace unisim::replay
