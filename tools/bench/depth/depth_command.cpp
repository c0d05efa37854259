// SPDX-License-Identifier: MIT
// unisim-bench depth: the ratio of two depth maps, by size.
#include "tools/bench/depth/depth_command.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/depth/log_median_ratio.hpp"
#include "drivers/common/format.hpp"
#include "tools/bench/process.hpp"
#include "tools/common/failure.hpp"
#include "tools/common/json_text.hpp"
#include "tools/common/output.hpp"
#include "tools/synth/random.hpp"

namespace unisim::bench {
namespace {

struct Size {
  int32_t width;
  int32_t height;
};

// The grids of a session at its smallest use and by default, common cameras, a network's output.
constexpr Size kSizes[] = {{20, 15}, {80, 60}, {160, 120}, {320, 240}, {518, 392}, {640, 480}};

constexpr int64_t kPixelsPerTiming = 1000000;  // one timing is far longer than the clock's grain

/// Two maps of one view: the second is noisy, in another unit, with some pixels of no depth.
struct Maps {
  explicit Maps(int32_t pixels) {
    synth::Random random(7);
    for (int32_t p = 0; p < pixels; ++p) {
      const double depth = random.uniform(1.0, 4.0);
      a.push_back(static_cast<float>(depth));
      const double seen = depth * 1.3 * random.uniform(0.9, 1.1);
      b.push_back(random.uniform() < 0.05 ? 0.0F : static_cast<float>(seen));
    }
    scratch.resize(static_cast<size_t>(log_median_ratio_scratch(pixels)));
  }
  std::vector<float> a, b, scratch;
};

Span<const float> view(const std::vector<float>& values) {
  return {values.data(), static_cast<int32_t>(values.size())};
}

void take_ratio(Maps* maps) {
  LogMedianRatio ratio{};
  const Status status =
      log_median_ratio(view(maps->a), view(maps->b),
                       {maps->scratch.data(), static_cast<int32_t>(maps->scratch.size())}, &ratio);
  if (!is_ok(status)) throw tools::Failure(tools::kExitOther, "log_median_ratio failed");
}

double median_ms(Maps* maps, int32_t repeat) {
  const int64_t calls =
      std::max<int64_t>(1, kPixelsPerTiming / static_cast<int64_t>(maps->a.size()));
  std::vector<double> times;
  for (int32_t k = 0; k < repeat; ++k) {
    const double start = process_cpu_ms();
    for (int64_t call = 0; call < calls; ++call) take_ratio(maps);
    times.push_back((process_cpu_ms() - start) / static_cast<double>(calls));
  }
  std::sort(times.begin(), times.end());
  return std::round(times[times.size() / 2] * 1e4) / 1e4;
}

}  // namespace

int depth_command(const DepthSettings& settings) {
  tools::Json sizes = tools::Json::array();
  for (const Size& size : kSizes) {
    Maps maps(size.width * size.height);
    sizes.push_back({{"width", size.width},
                     {"height", size.height},
                     {"ms", median_ms(&maps, settings.repeat)}});
  }
  if (settings.json) {
    tools::print(tools::json_text({{"depth_ratio", sizes}}) + "\n");
    return tools::kExitDone;
  }
  std::string text = drivers::format("%12s %12s\n", "size", "ms");
  for (const auto& row : sizes) {
    text += drivers::format("%7dx%-4d %12.4f\n", row["width"].get<int>(), row["height"].get<int>(),
                            row["ms"].get<double>());
  }
  tools::print(text);
  return tools::kExitDone;
}

}  // namespace unisim::bench
