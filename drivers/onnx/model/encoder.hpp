// SPDX-License-Identifier: MIT
// First part of a split model: from one image to features, run once for each keyframe.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/model/contract.hpp"
#include "drivers/onnx/predict/answer.hpp"
#include "drivers/onnx/runtime/cost.hpp"
#include "drivers/onnx/runtime/network.hpp"
#include "drivers/onnx/runtime/runtime.hpp"

namespace unisim::onnx {

class Encoder {
 public:
  /// Loads the file and holds it against the contract. @throws OnnxError
  Encoder(std::shared_ptr<const Runtime> runtime, const std::string& path,
          const RunOptions& options);

  const Contract& contract() const { return contract_; }
  const std::string& path() const { return network_.path(); }
  /// Of its output: (1,1,N,C).
  const std::vector<int64_t>& shape() const { return shape_; }

  /// First run; later ones take no memory of ours. @throws OnnxError
  void warm_up(const MemoryBudget& budget);
  const Cost& cost() const { return cost_; }

  /// Encodes the image that the caller has put into input(), 3 x height x width.
  /// Features that are not finite are refused here: a model after it could hide them.
  Answer run();
  float* input() { return image_.data(); }
  const std::vector<float>& features() const { return features_; }

  int64_t runs() const { return runs_; }  ///< since warm_up()
  int64_t bytes() const;

 private:
  Network network_;
  Contract contract_;
  std::vector<int64_t> shape_;
  std::vector<float> image_;
  std::vector<float> features_;
  std::unique_ptr<Network::Binding> binding_;
  Cost cost_;
  int64_t runs_ = 0;
};

}  // namespace unisim::onnx
