// SPDX-License-Identifier: MIT
// One session of ONNX Runtime: a loaded network, its metadata, its tensors, runs on bound buffers.
#pragma once

#include <onnxruntime_c_api.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/onnx/config.hpp"
#include "drivers/onnx/runtime/runtime.hpp"

namespace unisim::onnx {

/// An input or output as the file declares it.
struct TensorInfo {
  std::string name;
  const char* type = "no tensor";  ///< "float32", "float16" ...: static text
  std::vector<int64_t> shape;      ///< -1: any
};

/// A caller's float buffer under a tensor's name. The buffer must outlive the binding.
struct BoundTensor {
  const char* name;
  float* data;
  std::vector<int64_t> shape;
};

class Network {
 public:
  /// @throws OnnxError: BAD_MODEL for a file that cannot be read, NO_RUNTIME for a refused provider
  Network(std::shared_ptr<const Runtime> runtime, const std::string& path,
          const RunOptions& options);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  const std::string& path() const { return path_; }
  const Runtime& runtime() const { return *runtime_; }
  const std::vector<TensorInfo>& inputs() const { return inputs_; }
  const std::vector<TensorInfo>& outputs() const { return outputs_; }
  std::optional<std::string> metadata(const std::string& key) const;

  /// Buffers bound for one set of shapes.
  class Binding {
   public:
    Binding(const Network& network, const std::vector<BoundTensor>& inputs,
            const std::vector<BoundTensor>& outputs);
    ~Binding();
    Binding(const Binding&) = delete;
    Binding& operator=(const Binding&) = delete;

   private:
    friend class Network;
    OrtValue* make_value(const BoundTensor& tensor);

    const Network& network_;
    OrtIoBinding* binding_ = nullptr;
    OrtMemoryInfo* memory_ = nullptr;
    std::vector<OrtValue*> values_;
  };

  /// From the bound inputs to the bound outputs. @return "" or why it failed, in one line
  std::string run(const Binding& binding) const;

 private:
  void create(const RunOptions& options);
  std::vector<TensorInfo> describe(bool inputs) const;
  TensorInfo describe_one(bool input, size_t index) const;

  std::shared_ptr<const Runtime> runtime_;
  std::string path_;
  OrtSession* session_ = nullptr;
  OrtModelMetadata* metadata_ = nullptr;
  OrtAllocator* allocator_ = nullptr;
  std::vector<TensorInfo> inputs_;
  std::vector<TensorInfo> outputs_;
};

}  // namespace unisim::onnx
