// SPDX-License-Identifier: MIT
// What the landmarks look like.
#include "drivers/geometric/places/descriptor_store.hpp"

namespace unisim::geometric {

namespace {
// Keyframes until a landmark that stays in sight is described anew. Views nearer than that differ
// too little to be worth the time.
constexpr int32_t kNewView = 5;
constexpr size_t kPerLandmark = static_cast<size_t>(kDescribedViews) * kOrbScales;
}  // namespace

DescriptorStore::DescriptorStore(int32_t landmarks, size_t tracks)
    : entries_(static_cast<size_t>(landmarks)), descriptors_(entries_.size() * kPerLandmark) {
  points_.reserve(tracks);
  slots_.reserve(tracks);
  fresh_.reserve(tracks * kOrbScales);
  valid_.reserve(tracks);
}

bool DescriptorStore::wanted(const Entry& entry, uint32_t generation, int32_t keyframe) const {
  if (entry.generation != generation) return true;
  return keyframe >= std::max(entry.view[0].keyframe, entry.view[1].keyframe) + kNewView;
}

void DescriptorStore::see(const State& state, const cv::Mat& gray, int32_t keyframe, Orb* orb) {
  points_.clear();
  slots_.clear();
  for (size_t i = 0; i < state.tracks.size(); ++i) {
    const int32_t slot = state.tracks.landmark[i];
    const Landmark& mark = state.map.landmark(slot);
    if (mark.state != LandmarkState::kPlaced || mark.soft) continue;
    if (!wanted(entries_[static_cast<size_t>(slot)], mark.generation, keyframe)) continue;
    points_.push_back(state.tracks.point[i]);
    slots_.push_back(slot);
  }
  orb->describe_points(gray, points_, &fresh_, &valid_);
  for (size_t i = 0; i < slots_.size(); ++i) {
    if (valid_[i] == 0) continue;
    store(slots_[i], state.map.landmark(slots_[i]).generation, keyframe, i);
  }
}

void DescriptorStore::store(int32_t landmark, uint32_t generation, int32_t keyframe, size_t point) {
  Entry& entry = entries_[static_cast<size_t>(landmark)];
  size_t view = 1;
  if (entry.generation != generation) {
    entry = Entry{};
    entry.generation = generation;
    view = 0;
  }
  entry.view[view] = {valid_[point], keyframe};
  const size_t base = static_cast<size_t>(landmark) * kPerLandmark + view * kOrbScales;
  for (size_t s = 0; s < kOrbScales; ++s) descriptors_[base + s] = fresh_[point * kOrbScales + s];
}

void DescriptorStore::append(int32_t landmark, uint32_t generation,
                             std::vector<OrbDescriptor>* out) const {
  const Entry& entry = entries_[static_cast<size_t>(landmark)];
  if (entry.generation != generation) return;
  const size_t base = static_cast<size_t>(landmark) * kPerLandmark;
  for (size_t k = 0; k < kPerLandmark; ++k) {
    const View& view = entry.view[k / kOrbScales];
    if ((view.valid >> (k % kOrbScales)) & 1) out->push_back(descriptors_[base + k]);
  }
}

void DescriptorStore::archive(drivers::Archive* io, int32_t landmark, uint32_t generation) {
  Entry& entry = entries_[static_cast<size_t>(landmark)];
  bool kept = entry.generation == generation;
  io->flag(kept);
  if (!kept) return;
  entry.generation = generation;
  const size_t base = static_cast<size_t>(landmark) * kPerLandmark;
  for (size_t v = 0; v < kDescribedViews; ++v) {
    View& view = entry.view[v];
    io->number(view.valid);
    io->require(view.valid < 1 << kOrbScales, "a landmark is described at a scale that is none");
    io->number(view.keyframe, -1, drivers::kMostKeyframeId);
    for (size_t s = 0; s < kOrbScales; ++s) {
      if ((view.valid >> s) & 1)
        io->bytes(descriptors_[base + v * kOrbScales + s].data(), kOrbBytes);
    }
  }
}

int64_t DescriptorStore::bytes() const {
  const size_t all = entries_.capacity() * sizeof(Entry) +
                     (descriptors_.capacity() + fresh_.capacity()) * sizeof(OrbDescriptor) +
                     points_.capacity() * sizeof(cv::Point2f) +
                     slots_.capacity() * sizeof(int32_t) + valid_.capacity();
  return static_cast<int64_t>(all);
}

}  // namespace unisim::geometric
