// SPDX-License-Identifier: MIT
// Finds loops with a predictor that has no map of its own: a descriptor for each keyframe, a
// two-view prediction with old ones that look like it, a second keyframe that agrees, a window over
// both.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/common/place_reports.hpp"
#include "drivers/pipeline/loop_config.hpp"
#include "drivers/pipeline/messages.hpp"
#include "drivers/pipeline/place_book.hpp"
#include "drivers/pipeline/two_views.hpp"
#include "drivers/predictor.h"

namespace unisim::pipeline {

/// Descriptors come in beside a search; everything else waits for its end. What is found follows
/// from the keyframes handed over, not from when.
class LoopCloser {
 public:
  /// @param predictor with drivers::has_places(); borrowed
  /// @param window_size views that a window can have
  LoopCloser(const LoopConfig& config, unisim_predictor* predictor, int32_t window_size);

  /// Asks the predictor what the newest keyframe looks like. @return false: it is of no more use
  bool describe(int32_t id, Messages* messages);

  /// Hands described keyframes over to the next search.
  /// @param settled newest keyframe whose pair is settled: none after it
  /// @param first   oldest keyframe that the map holds
  /// @return there is something to search
  bool begin(int32_t settled, int32_t first);

  /// Goes on until a loop is found or all is looked at; calls the back group of the predictor only.
  void search();

  /// Of the last search: a window for unisim_add_loop(), NULL for none. Borrowed from the
  /// predictor.
  const unisim_window_prediction* found() const { return found_ ? &window_ : nullptr; }
  /// What became of found(). @param refused static text, NULL where the map has taken it
  void settle(const char* refused);
  /// Of the last search: why the predictor is of no more use, "" where it is.
  const std::string& failure() const { return failure_; }

  /// No more keyframes come.
  void finish();
  /// Fills the fields on places and loops, and adds the memory.
  void info(unisim_predictor_info* out) const;

 private:
  struct Described {
    int32_t id;
    std::vector<int8_t> values;  // empty: no descriptor
    int32_t image_width;
    int32_t image_height;
  };
  /// Two keyframes that show one place as far as the two tell.
  struct Sight {
    int32_t keyframe;
    int32_t candidate;
    unisim_sim3 T_candidate_keyframe;  ///< lengths in median depths of the candidate
  };

  bool due(int32_t id) const;
  void look(const Described& keyframe);
  bool compare(const Described& keyframe, const unisim_places_match& match);
  const char* inspect(const Described& keyframe, int32_t candidate, unisim_place_report* report,
                      Sight* sight);
  const Sight* companion(const Sight& sight) const;
  void close(const Sight& first, const Sight& second);
  std::vector<int32_t> views_of(const Sight& first, const Sight& second) const;
  bool ask(const std::vector<int32_t>& ids);
  void drop_unconfirmed(int32_t newest);
  static std::function<bool(const unisim_place_report&)> told_of(const Sight& sight);
  void decide(const char* reason, bool accepted);

  LoopConfig config_;
  unisim_predictor* predictor_;
  int32_t half_;  // views around each of the two places
  std::unique_ptr<PlaceBook> book_;
  std::vector<Described> waiting_;  // of the caller's thread
  std::vector<Described> work_;     // of the search
  size_t next_ = 0;                 // of work_
  std::vector<Sight> sights_;       // that wait for another to say the same
  std::vector<Sight> closing_;      // the two behind window_
  unisim_window_prediction window_{};
  bool found_ = false;
  int32_t first_ = 0;  // oldest keyframe that the map holds
  int32_t rest_until_ = 0;
  int32_t dimension_ = 0;
  std::string failure_;
  drivers::PlaceReports reports_;
};

}  // namespace unisim::pipeline
