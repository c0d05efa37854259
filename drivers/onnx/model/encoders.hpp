// SPDX-License-Identifier: MIT
// Finds the encoders that the models of a predictor need; one serves all models it fits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/model/encoder.hpp"
#include "drivers/onnx/model/model.hpp"

namespace unisim::onnx {

class Encoders {
 public:
  /// @param path encoder of all models that need one; "": X.encoder.onnx beside X.onnx
  Encoders(std::shared_ptr<const Runtime> runtime, const std::string& path,
           const RunOptions& options)
      : runtime_(std::move(runtime)), path_(path), options_(options) {}

  /// The encoder whose features the model takes; NULL when it takes images.
  /// @throws OnnxError when it is absent or another one
  std::shared_ptr<Encoder> of(const Model& model);

  const std::vector<std::shared_ptr<Encoder>>& loaded() const { return loaded_; }

 private:
  std::shared_ptr<const Runtime> runtime_;
  std::string path_;
  RunOptions options_;
  std::vector<std::shared_ptr<Encoder>> loaded_;
};

}  // namespace unisim::onnx
