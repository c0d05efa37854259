// SPDX-License-Identifier: MIT
// A network that keeps the model contract, with its buffers.
#include "drivers/onnx/model/model.hpp"

#include <algorithm>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/memory_use.hpp"
#include "drivers/onnx/runtime/tensor_check.hpp"

namespace unisim::onnx {

Model::Model(std::shared_ptr<const Runtime> runtime, const std::string& path,
             const RunOptions& options)
    : Model(std::make_shared<Network>(std::move(runtime), path, options)) {}

Model::Model(std::shared_ptr<Network> network)
    : network_(std::move(network)),
      contract_(read_contract(network_->path(),
                              [this](const std::string& key) { return network_->metadata(key); })) {
  check_tensors();
}

std::unique_ptr<Model> Model::another_lane() const {
  return std::unique_ptr<Model>(new Model(network_));
}

std::vector<int64_t> Model::input_shape(int64_t views) const {
  if (contract_.kind == Kind::kDescriptor) return {1, 3, contract_.height, contract_.width};
  if (contract_.takes_features) return {1, views, tokens_, channels_};
  return {1, views, 3, contract_.height, contract_.width};
}

void Model::check_input() {
  if (contract_.takes_features) {
    const std::vector<int64_t>& shape =
        require_only_input(*network_, "features", {1, kAnySize, kAnySize, kAnySize}).shape;
    tokens_ = shape[2];
    channels_ = shape[3];
    if (tokens_ < 1 || channels_ < 1) {
      throw OnnxError(UNISIM_ONNX_BAD_MODEL, path() + ": input features has shape " +
                                                 shape_text(shape) +
                                                 ", the last two sizes must be fixed");
    }
    view_floats_ = tokens_ * channels_;
    return;
  }
  const bool one = contract_.kind == Kind::kDescriptor;
  require_only_input(*network_, one ? "image" : "images", input_shape(kAnySize));
  view_floats_ = 3 * pixels();
}

void Model::check_tensors() {
  if (contract_.kind == Kind::kEncoder) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path() + ": is an encoder; give the model that takes its features");
  }
  check_input();
  if (contract_.kind == Kind::kDescriptor) {
    const int64_t length = require_output(*network_, "descriptor", {1, kAnySize}).shape[1];
    if (length < 1) {
      throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                      path() + ": output descriptor must have a fixed length");
    }
    descriptor_.resize(static_cast<size_t>(length));
    return;
  }
  require_output(*network_, "depth", {1, kAnySize, contract_.height, contract_.width});
  require_output(*network_, "confidence", {1, kAnySize, contract_.height, contract_.width});
  require_output(*network_, "pose", {1, kAnySize, 3, 4});
  require_output(*network_, "intrinsics", {1, kAnySize, 3, 3});
  for (const TensorInfo& output : network_->outputs()) {
    if (output.name != "pose_confidence") continue;
    require_output(*network_, output.name, {1, kAnySize});
    confidences_ = output.shape[1] == 1 ? 1 : -1;
  }
}

void Model::take_buffers(int32_t views) {
  const auto count = static_cast<size_t>(views);
  const auto size = static_cast<size_t>(pixels());
  input_.resize(count * static_cast<size_t>(view_floats_));
  if (contract_.kind == Kind::kDescriptor) return;
  depth_.resize(count * size);
  confidence_.resize(count * size);
  pose_.resize(count * 12);
  intrinsics_.resize(count * 9);
  pose_confidence_.resize(count);
}

void Model::bind(int32_t views) {
  const auto index = static_cast<size_t>(views);
  if (bindings_.size() <= index) bindings_.resize(index + 1);
  const int64_t height = contract_.height;
  const int64_t width = contract_.width;
  if (contract_.kind == Kind::kDescriptor) {
    bindings_[index] = std::make_unique<Network::Binding>(
        *network_, std::vector<BoundTensor>{{"image", input_.data(), input_shape(1)}},
        std::vector<BoundTensor>{
            {"descriptor", descriptor_.data(), {1, static_cast<int64_t>(descriptor_.size())}}});
    return;
  }
  std::vector<BoundTensor> outputs = {{"depth", depth_.data(), {1, views, height, width}},
                                      {"confidence", confidence_.data(), {1, views, height, width}},
                                      {"pose", pose_.data(), {1, views, 3, 4}},
                                      {"intrinsics", intrinsics_.data(), {1, views, 3, 3}}};
  if (confidences_ != 0) {
    outputs.push_back(
        {"pose_confidence", pose_confidence_.data(), {1, confidences_ == 1 ? 1 : views}});
  }
  const char* const input = contract_.takes_features ? "features" : "images";
  bindings_[index] = std::make_unique<Network::Binding>(
      *network_, std::vector<BoundTensor>{{input, input_.data(), input_shape(views)}}, outputs);
}

void Model::measure(int32_t views) {
  costs_.push_back(first_run(path(), views, contract_.peaks, [&] { return run(views); }));
}

int32_t Model::measured_views(int32_t fewest, int32_t most, const MemoryBudget& budget) {
  return views_within(budget.bytes, fewest, most, [&](int32_t count) {
    measure(count);
    return budget.needed(costs_.back());
  });
}

int32_t Model::stated_views(int32_t fewest, int32_t most, const MemoryBudget& budget) {
  measure(fewest);
  const auto cost = [&](int32_t count) {
    return Cost{count, 0, peak_bytes(contract_.peaks, count)};
  };
  int32_t count = most;
  while (count > fewest && budget.needed(cost(count)) > budget.bytes) --count;
  if (count > fewest) costs_.push_back(cost(count));
  return count;
}

void Model::warm_up(int32_t first, int32_t views, const MemoryBudget& budget) {
  const int32_t fewest = std::max(first, contract_.min_views);
  const int32_t most = std::max(std::min(views, contract_.max_views), fewest);
  take_buffers(most);
  // The bindings of all numbers of views exist before any run, so that none is made later.
  for (int32_t count = fewest; count <= most; ++count) bind(count);
  max_views_ = contract_.peaks.empty() ? measured_views(fewest, most, budget)
                                       : stated_views(fewest, most, budget);
  require_fit(path(), costs_.front(), budget);
}

int64_t Model::bytes() const {
  const size_t floats = input_.size() + depth_.size() + confidence_.size() + pose_.size() +
                        intrinsics_.size() + pose_confidence_.size() + descriptor_.size();
  return static_cast<int64_t>(floats * sizeof(float));
}

std::string Model::run(int32_t views) {
  const int32_t count = std::max(views, contract_.min_views);
  last_views_ = views;
  for (int32_t extra = views; extra < count; ++extra) {
    std::copy_n(input(views - 1), view_floats(), input(extra));
  }
  return network_->run(*bindings_[static_cast<size_t>(count)]);
}

float Model::pose_confidence() const {
  if (confidences_ == 0) return 1;
  const auto end = pose_confidence_.begin() + (confidences_ == 1 ? 1 : last_views_);
  return *std::min_element(pose_confidence_.begin(), end);
}

}  // namespace unisim::onnx
