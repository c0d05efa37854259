// SPDX-License-Identifier: MIT
// One session of ONNX Runtime.
#include "drivers/onnx/runtime/network.hpp"

#include <filesystem>
#include <numeric>

#include "drivers/onnx/error.hpp"
#include "drivers/onnx/runtime/providers.hpp"

namespace unisim::onnx {
namespace {

/// Session options that release themselves.
class SessionOptions {
 public:
  explicit SessionOptions(const Runtime& runtime) : runtime_(runtime) {
    check(runtime.api().CreateSessionOptions(&options_));
  }
  ~SessionOptions() { runtime_.api().ReleaseSessionOptions(options_); }
  SessionOptions(const SessionOptions&) = delete;
  SessionOptions& operator=(const SessionOptions&) = delete;

  void set(const RunOptions& run) {
    check(runtime_.api().SetIntraOpNumThreads(options_, run.threads));
    // Arena and memory pattern keep the largest inference's memory for good.
    check(runtime_.api().DisableCpuMemArena(options_));
    check(runtime_.api().DisableMemPattern(options_));
    // Idle threads sleep: the cores are shared with tracking.
    check(runtime_.api().AddSessionConfigEntry(options_, "session.intra_op.allow_spinning", "0"));
    append_provider(runtime_, run, options_);
  }
  OrtSessionOptions* get() const { return options_; }

 private:
  void check(OrtStatus* status) const {
    runtime_.check(status, UNISIM_ONNX_NO_RUNTIME, runtime_.name());
  }

  const Runtime& runtime_;
  OrtSessionOptions* options_ = nullptr;
};

bool is_about_the_file(OrtErrorCode code) {
  return code == ORT_NO_SUCHFILE || code == ORT_NO_MODEL || code == ORT_INVALID_PROTOBUF ||
         code == ORT_INVALID_GRAPH;
}

const char* type_name(ONNXTensorElementDataType type) {
  switch (type) {
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT:
      return "float32";
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT16:
      return "float16";
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_BFLOAT16:
      return "bfloat16";
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_DOUBLE:
      return "float64";
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_UINT8:
      return "uint8";
    default:
      return "another type than float";
  }
}

}  // namespace

Network::Network(std::shared_ptr<const Runtime> runtime, const std::string& path,
                 const RunOptions& options)
    : runtime_(std::move(runtime)), path_(path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                    path + ": no such file; give a model exported by tools/export/");
  }
  create(options);
  const OrtApi& api = runtime_->api();
  runtime_->check(api.GetAllocatorWithDefaultOptions(&allocator_), UNISIM_ONNX_NO_RUNTIME, path_);
  runtime_->check(api.SessionGetModelMetadata(session_, &metadata_), UNISIM_ONNX_BAD_MODEL, path_);
  inputs_ = describe(true);
  outputs_ = describe(false);
}

Network::~Network() {
  runtime_->api().ReleaseModelMetadata(metadata_);
  runtime_->api().ReleaseSession(session_);
}

void Network::create(const RunOptions& options) {
  SessionOptions session_options(*runtime_);
  session_options.set(options);
  OrtStatus* status = runtime_->api().CreateSession(&runtime_->env(), path_.c_str(),
                                                    session_options.get(), &session_);
  if (status == nullptr) return;
  const bool by_file = is_about_the_file(runtime_->api().GetErrorCode(status));
  const std::string reason = runtime_->take_message(status);
  if (options.provider != "cpu" && !by_file) {
    throw OnnxError(UNISIM_ONNX_NO_RUNTIME, path_ + ": provider " + options.provider + " of " +
                                                runtime_->name() + ": " + reason +
                                                "; is its device there? else take provider cpu");
  }
  throw OnnxError(UNISIM_ONNX_BAD_MODEL,
                  path_ + ": " + reason + "; is the file damaged, or made for a newer one than " +
                      runtime_->name() + "?");
}

std::vector<TensorInfo> Network::describe(bool inputs) const {
  size_t count = 0;
  const OrtApi& api = runtime_->api();
  runtime_->check(inputs ? api.SessionGetInputCount(session_, &count)
                         : api.SessionGetOutputCount(session_, &count),
                  UNISIM_ONNX_BAD_MODEL, path_);
  std::vector<TensorInfo> tensors;
  tensors.reserve(count);
  for (size_t i = 0; i < count; ++i) tensors.push_back(describe_one(inputs, i));
  return tensors;
}

TensorInfo Network::describe_one(bool input, size_t index) const {
  const OrtApi& api = runtime_->api();
  const auto check = [&](OrtStatus* status) {
    runtime_->check(status, UNISIM_ONNX_BAD_MODEL, path_);
  };
  TensorInfo tensor;
  char* name = nullptr;
  check(input ? api.SessionGetInputName(session_, index, allocator_, &name)
              : api.SessionGetOutputName(session_, index, allocator_, &name));
  tensor.name = name;
  check(api.AllocatorFree(allocator_, name));
  OrtTypeInfo* type = nullptr;
  check(input ? api.SessionGetInputTypeInfo(session_, index, &type)
              : api.SessionGetOutputTypeInfo(session_, index, &type));
  const OrtTensorTypeAndShapeInfo* shape = nullptr;
  OrtStatus* status = api.CastTypeInfoToTensorInfo(type, &shape);
  if (status == nullptr && shape != nullptr) {
    ONNXTensorElementDataType element = ONNX_TENSOR_ELEMENT_DATA_TYPE_UNDEFINED;
    size_t rank = 0;
    runtime_->take_message(api.GetTensorElementType(shape, &element));
    runtime_->take_message(api.GetDimensionsCount(shape, &rank));
    tensor.type = type_name(element);
    tensor.shape.resize(rank);
    status = api.GetDimensions(shape, tensor.shape.data(), rank);
  }
  api.ReleaseTypeInfo(type);
  check(status);
  return tensor;
}

std::optional<std::string> Network::metadata(const std::string& key) const {
  char* value = nullptr;
  const OrtApi& api = runtime_->api();
  runtime_->check(
      api.ModelMetadataLookupCustomMetadataMap(metadata_, allocator_, key.c_str(), &value),
      UNISIM_ONNX_BAD_MODEL, path_);
  if (value == nullptr) return std::nullopt;
  std::string text = value;
  runtime_->take_message(api.AllocatorFree(allocator_, value));
  return text;
}

Network::Binding::Binding(const Network& network, const std::vector<BoundTensor>& inputs,
                          const std::vector<BoundTensor>& outputs)
    : network_(network) {
  const Runtime& runtime = network.runtime();
  const OrtApi& api = runtime.api();
  const auto check = [&](OrtStatus* status) {
    runtime.check(status, UNISIM_ONNX_BAD_MODEL, network.path());
  };
  check(api.CreateCpuMemoryInfo(OrtDeviceAllocator, OrtMemTypeDefault, &memory_));
  check(api.CreateIoBinding(network.session_, &binding_));
  for (const BoundTensor& tensor : inputs) {
    check(api.BindInput(binding_, tensor.name, make_value(tensor)));
  }
  for (const BoundTensor& tensor : outputs) {
    check(api.BindOutput(binding_, tensor.name, make_value(tensor)));
  }
}

OrtValue* Network::Binding::make_value(const BoundTensor& tensor) {
  const int64_t count = std::accumulate(tensor.shape.begin(), tensor.shape.end(), int64_t{1},
                                        [](int64_t a, int64_t b) { return a * b; });
  OrtValue* value = nullptr;
  const Runtime& runtime = network_.runtime();
  runtime.check(
      runtime.api().CreateTensorWithDataAsOrtValue(
          memory_, tensor.data, static_cast<size_t>(count) * sizeof(float), tensor.shape.data(),
          tensor.shape.size(), ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT, &value),
      UNISIM_ONNX_BAD_MODEL, network_.path());
  values_.push_back(value);
  return value;
}

Network::Binding::~Binding() {
  const OrtApi& api = network_.runtime().api();
  api.ReleaseIoBinding(binding_);
  for (OrtValue* value : values_) api.ReleaseValue(value);
  api.ReleaseMemoryInfo(memory_);
}

std::string Network::run(const Binding& binding) const {
  return runtime_->take_message(
      runtime_->api().RunWithBinding(session_, nullptr, binding.binding_));
}

}  // namespace unisim::onnx
