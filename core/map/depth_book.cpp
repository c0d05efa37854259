// SPDX-License-Identifier: MIT
// Remembers what depth each keyframe had in which unit, and compares new depth with it.
#include "core/map/depth_book.hpp"

#include <algorithm>

namespace unisim {
namespace {

constexpr GridSize kCoarse = DepthArchive::kGrid;

void copy(Span<const float> from, Span<float> to) {
  std::copy(from.begin(), from.end(), to.begin());
}

}  // namespace

DepthBook::DepthBook(Arena& arena, const DepthBookSize& size, double confidence_drop)
    : two_view_(arena, size.two_view_slots, size.grid.cells()),
      submaps_(arena, size.submap_slots, size.grid.cells()),
      archive_(arena, size.keyframes),
      grid_(size.grid),
      confidence_drop_(confidence_drop),
      coarse_kept_(arena.take<float>(kCoarse.cells())),
      scratch_(arena.take<float>(
          log_median_ratio_scratch(std::max(size.grid.cells(), kCoarse.cells())))) {}

void DepthBook::sample(const DepthMap& map, SampledDepth* sampled) {
  sample_depth(map, kCoarse, confidence_drop_, sampled->coarse_, scratch_);
  const int32_t depths = sample_depth(map, grid_, confidence_drop_, sampled->fine_, scratch_);
  sampled->usable_ = depths >= kFewestSamples;
}

bool DepthBook::compare(Span<const float> map, Span<const float> kept, LogMedianRatio* ratio) {
  const Status status = log_median_ratio(map, kept, scratch_, ratio);
  return is_ok(status) && ratio->count >= kFewestSamples;
}

bool DepthBook::over_two_view(const SampledDepth& map, int32_t keyframe, LogMedianRatio* ratio) {
  const Span<const float> kept = two_view_.find(keyframe);
  if (!kept.empty()) return compare(map.fine_, kept, ratio);
  archive_.get(keyframe, coarse_kept_);
  return compare(map.coarse_, coarse_kept_, ratio);
}

bool DepthBook::over_submap(const SampledDepth& map, int32_t keyframe, LogMedianRatio* ratio) {
  const Span<const float> kept = submaps_.find(keyframe);
  return !kept.empty() && compare(map.fine_, kept, ratio);
}

void DepthBook::keep_two_view(const SampledDepth& map, int32_t keyframe) {
  const Span<float> place = two_view_.put({keyframe, -1, -1});
  if (!place.empty()) copy(map.fine_, place);
  archive_.put(keyframe, map.coarse_);
}

void DepthBook::keep_submap(const SampledDepth& map, const DepthStore::Source& source) {
  const Span<float> place = submaps_.put(source);
  if (!place.empty()) copy(map.fine_, place);
}

}  // namespace unisim
