// SPDX-License-Identifier: MIT
// Which submap a window of the predictor became.
#include "drivers/pipeline/window_book.hpp"

#include <algorithm>
#include <utility>

#include "drivers/common/archive.hpp"
#include "drivers/mapfile/byte_stream.hpp"

namespace unisim::pipeline {
namespace {

constexpr int32_t kMostSubmap = 1 << 30;

void archive(drivers::Archive* io, int32_t keyframes, int32_t* submap_id,
             std::vector<int32_t>* ids) {
  io->number(*submap_id, 0, kMostSubmap);
  auto count = static_cast<int32_t>(ids->size());
  io->number(count, 1, UNISIM_MAX_VIEWS);
  ids->resize(static_cast<size_t>(count));
  int32_t least = 0;
  for (int32_t& id : *ids) {
    io->number(id, least, keyframes - 1);
    least = id + 1;
  }
}

}  // namespace

void WindowBook::add(Window window) {
  if (windows_.size() < most_) {
    windows_.push_back(std::move(window));
  } else {
    windows_[next_ % most_] = std::move(window);
  }
  ++next_;
}

void WindowBook::add(const unisim_window_prediction& window, int32_t submap_id) {
  add({window.token, submap_id, {window.keyframe_ids, window.keyframe_ids + window.count}});
}

int32_t WindowBook::submap_of(int64_t token) const {
  const auto found = std::find_if(windows_.begin(), windows_.end(),
                                  [token](const Window& one) { return one.token == token; });
  return found == windows_.end() ? -1 : found->submap_id;
}

mapfile::Bytes WindowBook::bytes() const {
  mapfile::Bytes bytes;
  drivers::Archive io(mapfile::append_bytes, &bytes);
  for (size_t k = 0; k < windows_.size(); ++k) {
    Window one = windows_[(next_ + k) % windows_.size()];
    archive(&io, drivers::kMostKeyframeId, &one.submap_id, &one.keyframes);
  }
  return bytes;
}

void WindowBook::load(const mapfile::Bytes& bytes, const std::string& path, int32_t keyframes,
                      unisim_predictor* predictor) {
  mapfile::ByteSource rest{bytes};
  std::vector<Window> loaded;
  try {
    drivers::Archive io(mapfile::take_bytes, &rest);
    io.part("part windows");
    while (rest.at < bytes.size()) {
      Window one;
      archive(&io, keyframes, &one.submap_id, &one.keyframes);
      loaded.push_back(std::move(one));
    }
  } catch (const drivers::ArchiveError& error) {
    throw mapfile::Error(mapfile::Error::Kind::kInput, path + ": " + error.what());
  }
  for (Window& one : loaded) {
    unisim_window_prediction window{};
    const auto count = static_cast<int32_t>(one.keyframes.size());
    if (predictor->multi_view(predictor, one.keyframes.data(), count, &window) !=
        UNISIM_PREDICTION_OK) {
      continue;
    }
    const bool whole = std::equal(one.keyframes.begin(), one.keyframes.end(), window.keyframe_ids,
                                  window.keyframe_ids + window.count);
    one.token = window.token;
    if (whole) add(std::move(one));
  }
}

}  // namespace unisim::pipeline
