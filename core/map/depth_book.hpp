// SPDX-License-Identifier: MIT
// Remembers what depth each keyframe had in which unit, and compares new depth with it.
#pragma once

#include <cstdint>

#include "core/depth/log_median_ratio.hpp"
#include "core/map/depth_archive.hpp"
#include "core/map/depth_sampler.hpp"
#include "core/map/depth_store.hpp"

namespace unisim {

/// Sizes of a DepthBook.
struct DepthBookSize {
  int32_t keyframes = 0;       ///< newest ones whose coarse depth is kept
  int32_t two_view_slots = 0;  ///< newest keyframes whose two-view depth is kept on the grid
  int32_t submap_slots = 0;    ///< submap views whose depth is kept on the grid
  GridSize grid;
};

/// A host's map on the two grids of a DepthBook.
class SampledDepth {
 public:
  SampledDepth() = default;
  SampledDepth(Arena& arena, GridSize grid)
      : fine_(arena.take<float>(grid.cells())),
        coarse_(arena.take<float>(DepthArchive::kGrid.cells())) {}

  /// Has it enough depths for any use?
  bool usable() const { return usable_; }

 private:
  friend class DepthBook;
  Span<float> fine_;
  Span<float> coarse_;
  bool usable_ = false;
};

/// Depth of keyframes by unit: one unit per two-view chain link, one per submap.
///
/// sample() a host's map, then compare it or keep it. Comparing falls back from the grid to the
/// coarse archive for keyframes whose grid has given way; below kFewestSamples common samples a
/// ratio is unknown.
class DepthBook {
 public:
  static constexpr int32_t kFewestSamples = 16;

  DepthBook() = default;
  DepthBook(Arena& arena, const DepthBookSize& size, double confidence_drop);

  /// @param[out] sampled made on the same grid as the book
  void sample(const DepthMap& map, SampledDepth* sampled);

  /// log median(map / two-view depth of the keyframe). false: unknown.
  bool over_two_view(const SampledDepth& map, int32_t keyframe, LogMedianRatio* ratio);
  /// log median(map / depth of the keyframe in the submap last kept). false: unknown.
  bool over_submap(const SampledDepth& map, int32_t keyframe, LogMedianRatio* ratio);
  /// Which submap view over_submap() would compare with.
  DepthStore::Source submap_source(int32_t keyframe) const { return submaps_.source_of(keyframe); }

  /// A keyframe has arrived: what was archived in its place is another's.
  void begin_keyframe(int32_t keyframe) { archive_.clear(keyframe); }
  /// The map is the keyframe's two-view depth from now on.
  void keep_two_view(const SampledDepth& map, int32_t keyframe);
  /// The map is the depth of a submap's view.
  void keep_submap(const SampledDepth& map, const DepthStore::Source& source);
  /// A submap's view has been measured anew: its depth is `factor` times the old.
  void rescale_submap(int32_t submap, int32_t view, double factor) {
    submaps_.rescale(submap, view, factor);
  }

  /// Save or load; of the coarse depth, that of keyframes first .. end - 1.
  void visit(Archive* archive, int32_t first, int32_t end) {
    two_view_.visit(archive);
    submaps_.visit(archive);
    archive_.visit(archive, first, end);
  }
  /// Views over_submap() compares with; keyframe -1: none.
  Span<const DepthStore::Source> submap_sources() const { return submaps_.sources(); }

 private:
  bool compare(Span<const float> map, Span<const float> kept, LogMedianRatio* ratio);

  DepthStore two_view_;
  DepthStore submaps_;
  DepthArchive archive_;
  GridSize grid_;
  double confidence_drop_ = 0.0;
  Span<float> coarse_kept_;  // a keyframe out of the archive
  Span<float> scratch_;
};

}  // namespace unisim
