// SPDX-License-Identifier: MIT
// Looks at places reach the listeners, though a predictor keeps the newest only.
#include "drivers/common/place_reports.hpp"
#include "tests/pipeline/scripted_run.hpp"

using namespace unisim;
using namespace unisim::testing;

namespace {

constexpr int32_t kLooks = 40;         // at each keyframe
constexpr int32_t kDecidedAfter = 90;  // looks

/// Looks numbered by their keyframe, each of which is accepted some looks later.
struct Looks {
  drivers::PlaceReports reports;
  int32_t count = 0;

  void add() {
    unisim_place_report look{};
    look.keyframe = count++;
    look.reason = "open";
    reports.add(look);
    const int32_t decided = count - kDecidedAfter;
    reports.decide([&](const unisim_place_report& one) { return one.keyframe == decided; }, true,
                   "accepted");
  }
};

Looks* asked = nullptr;

}  // namespace

TEST_CASE("every look at a place is told once, in order, when its verdict stands") {
  Looks looks;
  asked = &looks;
  Run run;
  run.predictor.table()->info = [](unisim_predictor*, unisim_predictor_info* out) {
    *out = {};
    for (int32_t k = 0; k < kLooks; ++k) asked->add();
    asked->reports.info(out);
  };
  const unisim_predictor_info& info = run.go().predictor;
  REQUIRE(info.places_past > 0);
  REQUIRE(info.places_past + info.place_count == looks.count);
  const std::vector<unisim_place_report>& told = run.listener.places;
  REQUIRE(static_cast<int32_t>(told.size()) >= info.places_past);
  for (size_t k = 0; k < told.size(); ++k) {
    CAPTURE(k);
    CHECK(told[k].keyframe == static_cast<int32_t>(k));
    CHECK(told[k].accepted == 1);
  }
}
