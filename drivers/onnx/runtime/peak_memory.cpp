// SPDX-License-Identifier: MIT
// Peak memory of an inference as a model's file states it.
#include "drivers/onnx/runtime/peak_memory.hpp"

#include <algorithm>
#include <locale>
#include <sstream>

namespace unisim::onnx {
namespace {

// More memory than this is no statement but a slip.
constexpr int64_t kMostBytes = int64_t{1} << 50;
constexpr int32_t kMostViews = 65536;

}  // namespace

std::optional<std::vector<PeakMemory>> read_peaks(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<PeakMemory> peaks;
  PeakMemory peak;
  char colon = 0;
  while (stream >> std::ws && stream.peek() != std::istringstream::traits_type::eof()) {
    const int32_t last = peaks.empty() ? 0 : peaks.back().views;
    if (!(stream >> peak.views >> colon >> peak.bytes) || colon != ':') return std::nullopt;
    if (peak.views <= last || peak.views > kMostViews) return std::nullopt;
    if (peak.bytes < 1 || peak.bytes > kMostBytes) return std::nullopt;
    peaks.push_back(peak);
  }
  if (peaks.empty()) return std::nullopt;
  return peaks;
}

int64_t peak_bytes(const std::vector<PeakMemory>& stated, int32_t views) {
  const auto above = std::find_if(stated.begin(), stated.end(),
                                  [&](const PeakMemory& peak) { return peak.views >= views; });
  if (above == stated.begin()) return stated.front().bytes;
  if (above == stated.end()) {
    const double ratio = static_cast<double>(views) / stated.back().views;
    return static_cast<int64_t>(ratio * ratio * static_cast<double>(stated.back().bytes));
  }
  const PeakMemory& below = *(above - 1);
  const double share =
      static_cast<double>(views - below.views) / static_cast<double>(above->views - below.views);
  return below.bytes +
         static_cast<int64_t>(share * static_cast<double>(above->bytes - below.bytes));
}

}  // namespace unisim::onnx
