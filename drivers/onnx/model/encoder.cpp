// SPDX-License-Identifier: MIT
// First part of a split model.
#include "drivers/onnx/model/encoder.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/tensor_check.hpp"

namespace unisim::onnx {

Encoder::Encoder(std::shared_ptr<const Runtime> runtime, const std::string& path,
                 const RunOptions& options)
    : network_(std::move(runtime), path, options),
      contract_(
          read_contract(path, [this](const std::string& key) { return network_.metadata(key); })) {
  if (contract_.kind != Kind::kEncoder) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path + ": is not of kind encoder; give the encoder of the split model");
  }
  const std::vector<int64_t> image_shape = {1, 1, 3, contract_.height, contract_.width};
  require_only_input(network_, "images", image_shape);
  shape_ = require_output(network_, "features", {1, 1, kAnySize, kAnySize}).shape;
  shape_[0] = shape_[1] = 1;
  if (shape_[2] < 1 || shape_[3] < 1) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path + ": output features must have fixed sizes, not " + shape_text(shape_));
  }
  image_.resize(static_cast<size_t>(int64_t{3} * contract_.height * contract_.width));
  features_.resize(static_cast<size_t>(shape_[2] * shape_[3]));
  binding_ = std::make_unique<Network::Binding>(
      network_, std::vector<BoundTensor>{{"images", image_.data(), image_shape}},
      std::vector<BoundTensor>{{"features", features_.data(), shape_}});
}

void Encoder::warm_up(const MemoryBudget& budget) {
  cost_ = first_run(path(), 1, contract_.peaks, [this] { return network_.run(*binding_); });
  require_fit(path(), cost_, budget);
}

Answer Encoder::run() {
  ++runs_;
  const std::string problem = network_.run(*binding_);
  if (!problem.empty()) return {path() + ": " + problem, true};
  const bool finite = std::all_of(features_.begin(), features_.end(),
                                  [](float value) { return std::isfinite(value); });
  return {finite ? "" : "features are not finite", false};
}

int64_t Encoder::bytes() const {
  return static_cast<int64_t>((image_.size() + features_.size()) * sizeof(float));
}

}  // namespace unisim::onnx
