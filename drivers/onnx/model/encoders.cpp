// SPDX-License-Identifier: MIT
// Finds the encoders that the models of a predictor need.
#include "drivers/onnx/model/encoders.hpp"

#include <algorithm>
#include <filesystem>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/tensor_check.hpp"

namespace unisim::onnx {
namespace {

/// "X.onnx" to "X.encoder.onnx".
std::string encoder_beside(const std::string& model) {
  std::filesystem::path path = model;
  return path.replace_extension(".encoder.onnx").string();
}

/// First metadata key about the image in which the two files differ, "" when none does.
std::string other_preprocessing(const Contract& a, const Contract& b) {
  if (a.height != b.height) return "height";
  if (a.width != b.width) return "width";
  if (a.multiple != b.multiple) return "multiple";
  if (a.mean != b.mean) return "mean";
  if (a.std != b.std) return "std";
  if (a.resize != b.resize) return "resize";
  return a.pad_value != b.pad_value ? "pad_value" : "";
}

void require_match(const Model& model, const Encoder& encoder) {
  const auto require = [&](bool good, const std::string& what) {
    if (!good) throw OnnxError(UNISIM_ONNX_BAD_MODEL, model.path() + ": " + what);
  };
  const std::string& own = encoder.contract().encoder;
  require(model.contract().encoder == own,
          "unisim.encoder is " + model.contract().encoder + ", but " + encoder.path() + " is " +
              own + "; give the encoder that was exported with this model");
  const std::string key = other_preprocessing(model.contract(), encoder.contract());
  require(key.empty(),
          "unisim." + key + " is not that of " + encoder.path() + "; export both files together");
  require(model.input_shape(1) == encoder.shape(),
          "input features has shape " + shape_text(model.input_shape(kAnySize)) + ", but " +
              encoder.path() + " makes " + shape_text(encoder.shape()) +
              "; export both files together");
}

}  // namespace

std::shared_ptr<Encoder> Encoders::of(const Model& model) {
  if (!model.contract().takes_features) return nullptr;
  const auto same = [&](const std::shared_ptr<Encoder>& encoder) {
    return encoder->contract().encoder == model.contract().encoder;
  };
  auto found = std::find_if(loaded_.begin(), loaded_.end(), same);
  if (found == loaded_.end()) {
    const std::string path = path_.empty() ? encoder_beside(model.path()) : path_;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
      throw OnnxError(UNISIM_ONNX_BAD_MODEL, model.path() + ": takes the features of an encoder, " +
                                                 path +
                                                 " is no file; put it there or name it by option");
    }
    loaded_.push_back(std::make_shared<Encoder>(runtime_, path, options_));
    found = loaded_.end() - 1;
  }
  require_match(model, **found);
  return *found;
}

}  // namespace unisim::onnx
