// SPDX-License-Identifier: MIT
// Lines about loaded models.
#include "drivers/onnx/model/model_notes.hpp"

#include "drivers/common/format.hpp"

namespace unisim::onnx {
namespace {

std::string megabytes(int64_t bytes) {
  return drivers::format("%.3g MB", static_cast<double>(bytes) / (1 << 20));
}

}  // namespace

std::string licence_line(const Contract& contract) {
  return contract.model + ", " + std::to_string(contract.width) + "x" +
         std::to_string(contract.height) + ", licence: " + contract.license;
}

std::string cost_line(const Contract& contract, const std::string& what,
                      const std::vector<Cost>& costs) {
  std::string line = contract.model + what + ":";
  for (const Cost& cost : costs) {
    line += (line.back() == ':' ? " " : ", ") + std::to_string(cost.views) + " view(s)";
    if (cost.seconds > 0) line += drivers::format(" %.3g s and", cost.seconds);
    line += " " + megabytes(cost.bytes);
  }
  return line + (contract.peaks.empty() ? " at the first run" : ", memory as its file states");
}

std::string ring_line(const Views& views) {
  const char* const what = views.encoder() != nullptr ? "features" : "images";
  return std::string(what) + " of the newest " + std::to_string(views.capacity()) +
         " keyframes are kept: " + megabytes(views.ring_bytes());
}

std::string reduction_line(const Model& model, int32_t wanted, int64_t memory_bytes) {
  const int32_t views = model.max_views();
  if (views >= wanted) return "";
  const bool by_model = model.contract().max_views < wanted && views == model.contract().max_views;
  const std::string why =
      by_model ? "the model takes no more views"
               : "more would not fit " + std::to_string(memory_bytes >> 20) + " MB of memory";
  return "windows have " + std::to_string(views) + " keyframes in place of " +
         std::to_string(wanted) + ": " + why;
}

}  // namespace unisim::onnx
