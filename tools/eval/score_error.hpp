// SPDX-License-Identifier: MIT
// Why two trajectories give no figure.
#pragma once

#include <string>

#include "drivers/sequence/text_file.hpp"

namespace unisim::eval {

/// Two readable trajectories that do not give the figure that was asked for. The text says what is
/// the matter; which option may help is for the program to say, by this kind.
class ScoreError : public sequence::InputError {
 public:
  enum class Kind {
    kNoPairs,   ///< no poses near enough in time
    kFewPairs,  ///< too few to align
    kStill,     ///< positions that do not move give no scale
    kNoStep,    ///< no two poses a step apart
    kNoTimes,   ///< frame numbers where a time is needed
  };

  ScoreError(Kind kind, const std::string& line) : InputError(line), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace unisim::eval
