// SPDX-License-Identifier: MIT
// Small image patches of landmarks, from which landmarks that went out of sight are found again.
#include "drivers/geometric/image/patch_store.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace unisim::geometric {

namespace {
constexpr size_t kPatchBytes = static_cast<size_t>(kPatchSide) * kPatchSide;
}  // namespace

PatchStore::PatchStore(int32_t landmarks)
    : views_(static_cast<size_t>(landmarks) * kPatchesPerLandmark),
      pixels_(views_.size() * kPatchBytes) {}

cv::Mat PatchStore::pixels(int32_t landmark, int index) const {
  // cv::Mat has no read-only view; callers only read.
  auto* data = const_cast<uint8_t*>(pixels_.data() + at(landmark, index) * kPatchBytes);
  return {kPatchSide, kPatchSide, CV_8UC1, data};
}

void PatchStore::store(int32_t landmark, int index, uint32_t generation, int32_t keyframe,
                       const cv::Mat& gray, const cv::Point2f& point) {
  const cv::Point2f middle(std::floor(point.x), std::floor(point.y));
  // With this centre every sample falls on a pixel: a copy with repeated edges.
  const cv::Point2f center(middle.x - 0.5F, middle.y - 0.5F);
  cv::Mat target = pixels(landmark, index);
  cv::getRectSubPix(gray, cv::Size(kPatchSide, kPatchSide), center, target);
  PatchView& view = views_[at(landmark, index)];
  view.generation = generation;
  view.keyframe = keyframe;
  view.offset = point - middle;
}

void PatchStore::archive(drivers::Archive* io, int32_t landmark, uint32_t generation) {
  for (int index = 0; index < kPatchesPerLandmark; ++index) {
    PatchView& patch = views_[at(landmark, index)];
    bool kept = patch.generation == generation;
    io->flag(kept);
    if (!kept) continue;
    patch.generation = generation;
    io->number(patch.keyframe, 0, drivers::kMostKeyframeId);
    io->number(patch.offset.x);
    io->number(patch.offset.y);
    // Within the pixel; not a number is neither.
    io->require(
        patch.offset.x >= 0 && patch.offset.x <= 1 && patch.offset.y >= 0 && patch.offset.y <= 1,
        "a patch lies beside its landmark");
    io->bytes(pixels_.data() + at(landmark, index) * kPatchBytes, kPatchBytes);
  }
}

int64_t PatchStore::bytes() const {
  return static_cast<int64_t>(views_.capacity() * sizeof(PatchView) + pixels_.capacity());
}

}  // namespace unisim::geometric
