// SPDX-License-Identifier: MIT
// A network that keeps the model contract, with the buffers of one lane.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/model/contract.hpp"
#include "drivers/onnx/runtime/cost.hpp"
#include "drivers/onnx/runtime/network.hpp"
#include "drivers/onnx/runtime/runtime.hpp"

namespace unisim::onnx {

class Model {
 public:
  /// Loads the file and holds it against the contract. @throws OnnxError
  Model(std::shared_ptr<const Runtime> runtime, const std::string& path, const RunOptions& options);

  /// The same network, loaded once, with buffers of its own: the two may run beside each other.
  std::unique_ptr<Model> another_lane() const;
  bool same_network(const Model& other) const { return network_ == other.network_; }

  const Contract& contract() const { return contract_; }
  const std::string& path() const { return network_->path(); }
  /// Of one view's input.
  int64_t view_floats() const { return view_floats_; }
  int64_t view_bytes() const { return view_floats_ * static_cast<int64_t>(sizeof(float)); }
  /// Of its input with so many views: images or the features of an encoder.
  std::vector<int64_t> input_shape(int64_t views) const;
  int64_t pixels() const { return int64_t{contract_.height} * contract_.width; }

  /// Takes the buffers for up to `views`, runs `first` of them and finds out how many fit the
  /// memory budget: by running more or, where the file states its memory, from that. Later runs
  /// take no memory of ours.
  /// @param first  the number that must fit @throws OnnxError (NO_MEMORY) when it does not
  void warm_up(int32_t first, int32_t views, const MemoryBudget& budget);

  int32_t max_views() const { return max_views_; }  ///< after warm_up()
  const std::vector<Cost>& costs() const { return costs_; }
  int64_t bytes() const;

  /// One inference. The input is filled by the caller, view by view; a model whose fewest views are
  /// more than asked for gets the last one repeated.
  /// @return "" or why it failed, in one line
  std::string run(int32_t views);
  float* input(int32_t view) { return input_.data() + view * view_floats(); }

  // Of the last run.
  const float* depth(int32_t view) const { return depth_.data() + view * pixels(); }
  const float* confidence(int32_t view) const { return confidence_.data() + view * pixels(); }
  const float* pose(int32_t view) const { return pose_.data() + view * 12; }
  const float* intrinsics(int32_t view) const { return intrinsics_.data() + view * 9; }
  /// Least of the model's pose confidences, 1 where it gives none.
  float pose_confidence() const;
  /// Of kind descriptor.
  const std::vector<float>& descriptor() const { return descriptor_; }

 private:
  explicit Model(std::shared_ptr<Network> network);

  void check_tensors();
  void check_input();
  void take_buffers(int32_t views);
  void bind(int32_t views);
  void measure(int32_t views);
  int32_t measured_views(int32_t fewest, int32_t most, const MemoryBudget& budget);
  int32_t stated_views(int32_t fewest, int32_t most, const MemoryBudget& budget);

  std::shared_ptr<Network> network_;
  Contract contract_;
  int64_t tokens_ = 0;    // of the features of one view
  int64_t channels_ = 0;  // of each token
  int64_t view_floats_ = 0;
  int32_t max_views_ = 0;
  int32_t confidences_ = 0;  // of the pose: 0 none, 1 one, -1 one per view
  int32_t last_views_ = 0;   // of the last run
  std::vector<float> input_, depth_, confidence_, pose_, intrinsics_, pose_confidence_, descriptor_;
  std::vector<std::unique_ptr<Network::Binding>> bindings_;  // by number of views
  std::vector<Cost> costs_;
};

}  // namespace unisim::onnx
