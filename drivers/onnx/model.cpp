// SPDX-License-Identifier: MIT
// A network that keeps the model contract, with its buffers.
#include "drivers/onnx/model.hpp"

#include <algorithm>
#include <chrono>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/memory_use.hpp"

namespace unisim::onnx {
namespace {

constexpr int64_t kAny = -1;

std::string shape_text(const std::vector<int64_t>& shape) {
  std::string text;
  for (const int64_t size : shape) {
    text += (text.empty() ? "(" : ",") + (size < 0 ? "V" : std::to_string(size));
  }
  return text + ")";
}

/// Could a tensor declared like this have that shape?
bool admits(const std::vector<int64_t>& declared, const std::vector<int64_t>& wanted) {
  if (declared.size() != wanted.size()) return false;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (declared[i] >= 0 && wanted[i] >= 0 && declared[i] != wanted[i]) return false;
  }
  return true;
}

}  // namespace

Model::Model(std::shared_ptr<const Runtime> runtime, const std::string& path,
             const RunOptions& options)
    : network_(std::move(runtime), path, options),
      contract_(
          read_contract(path, [this](const std::string& key) { return network_.metadata(key); })) {
  check_tensors();
}

void Model::check_input(const TensorInfo& input) const {
  const bool one = contract_.kind == Kind::kDescriptor;
  const std::string name = one ? "image" : "images";
  std::vector<int64_t> shape = {1, 3, contract_.height, contract_.width};
  if (!one) shape.insert(shape.begin() + 1, kAny);
  if (input.name != name) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL, path() + ": takes input \"" + input.name +
                                               "\", the contract has \"" + name + "\" alone");
  }
  if (!input.is_float || !admits(input.shape, shape)) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL, path() + ": input " + name + " has shape " +
                                               shape_text(input.shape) +
                                               ", the contract wants float32 " + shape_text(shape));
  }
}

void Model::check_output(const std::string& name, const std::vector<int64_t>& shape) const {
  const auto& outputs = network_.outputs();
  const auto found = std::find_if(outputs.begin(), outputs.end(),
                                  [&](const TensorInfo& output) { return output.name == name; });
  if (found == outputs.end()) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path() + ": has no output " + name + "; export the model with tools/export/");
  }
  if (!found->is_float || !admits(found->shape, shape)) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL, path() + ": output " + name + " has shape " +
                                               shape_text(found->shape) +
                                               ", the contract wants float32 " + shape_text(shape));
  }
}

void Model::check_tensors() {
  if (network_.inputs().empty()) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL, path() + ": takes no input");
  }
  for (const TensorInfo& input : network_.inputs()) check_input(input);
  if (contract_.kind == Kind::kDescriptor) {
    check_output("descriptor", {1, kAny});
    const auto& outputs = network_.outputs();
    const auto found = std::find_if(outputs.begin(), outputs.end(),
                                    [](const TensorInfo& o) { return o.name == "descriptor"; });
    if (found->shape[1] < 1) {
      throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                      path() + ": output descriptor must have a fixed length");
    }
    descriptor_.resize(static_cast<size_t>(found->shape[1]));
    return;
  }
  check_output("depth", {1, kAny, contract_.height, contract_.width});
  check_output("confidence", {1, kAny, contract_.height, contract_.width});
  check_output("pose", {1, kAny, 3, 4});
  check_output("intrinsics", {1, kAny, 3, 3});
  for (const TensorInfo& output : network_.outputs()) {
    if (output.name != "pose_confidence") continue;
    check_output("pose_confidence", {1, kAny});
    confidences_ = output.shape[1] == 1 ? 1 : -1;
  }
}

void Model::take_buffers(int32_t views) {
  const auto count = static_cast<size_t>(views);
  const auto size = static_cast<size_t>(pixels());
  images_.resize(count * 3 * size);
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
        network_, std::vector<BoundTensor>{{"image", images_.data(), {1, 3, height, width}}},
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
  bindings_[index] = std::make_unique<Network::Binding>(
      network_, std::vector<BoundTensor>{{"images", images_.data(), {1, views, 3, height, width}}},
      outputs);
}

void Model::measure(int32_t views) {
  Cost cost;
  cost.views = views;
  std::string problem;
  const auto start = std::chrono::steady_clock::now();
  cost.bytes = peak_growth_bytes([&] { problem = run(views); });
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  cost.seconds = spent.count();
  if (!problem.empty()) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path() + ": cannot run " + std::to_string(views) + " view(s): " + problem);
  }
  costs_.push_back(cost);
}

void Model::warm_up(int32_t first, int32_t views, int64_t memory_bytes) {
  const int32_t fewest = std::max(first, contract_.min_views);
  const int32_t most = std::max(std::min(views, contract_.max_views), fewest);
  take_buffers(most);
  // The bindings of all numbers of views exist before any run, so that none is made later.
  for (int32_t count = fewest; count <= most; ++count) bind(count);
  int64_t bytes = 0;
  max_views_ = views_within(
      memory_bytes, fewest, most,
      [this](int32_t count) {
        measure(count);
        return costs_.back().bytes;
      },
      &bytes);
  if (bytes > memory_bytes) {
    throw OnnxError(UNISIM_ONNX_NO_MEMORY,
                    path() + ": " + std::to_string(fewest) + " view(s) take " +
                        std::to_string(bytes >> 20) + " MB, more than the " +
                        std::to_string(memory_bytes >> 20) +
                        " MB allowed; raise the memory option or export a smaller input size");
  }
}

int64_t Model::bytes() const {
  const size_t floats = images_.size() + depth_.size() + confidence_.size() + pose_.size() +
                        intrinsics_.size() + pose_confidence_.size() + descriptor_.size();
  return static_cast<int64_t>(floats * sizeof(float));
}

std::string Model::run(int32_t views) {
  const int32_t count = std::max(views, contract_.min_views);
  last_views_ = views;
  for (int32_t extra = views; extra < count; ++extra) {
    std::copy_n(input(views - 1), view_floats(), input(extra));
  }
  return network_.run(*bindings_[static_cast<size_t>(count)]);
}

float Model::pose_confidence() const {
  if (confidences_ == 0) return 1;
  const auto end = pose_confidence_.begin() + (confidences_ == 1 ? 1 : last_views_);
  return *std::min_element(pose_confidence_.begin(), end);
}

}  // namespace unisim::onnx
