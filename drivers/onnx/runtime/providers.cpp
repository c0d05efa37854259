// SPDX-License-Identifier: MIT
// Execution providers: on what a network runs.
#include "drivers/onnx/runtime/providers.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "drivers/onnx/error.hpp"

namespace unisim::onnx {
namespace {

/// "CUDAExecutionProvider" to "CUDA".
std::string short_name(std::string name) {
  const std::string tail = "ExecutionProvider";
  if (name.size() > tail.size() &&
      name.compare(name.size() - tail.size(), tail.size(), tail) == 0) {
    name.resize(name.size() - tail.size());
  }
  return name;
}

std::string lower(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return name;
}

std::vector<std::string> available(const Runtime& runtime) {
  char** names = nullptr;
  int count = 0;
  runtime.check(runtime.api().GetAvailableProviders(&names, &count), UNISIM_ONNX_NO_RUNTIME,
                runtime.name());
  std::vector<std::string> found;
  found.reserve(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) found.push_back(short_name(names[i]));
  runtime.take_message(runtime.api().ReleaseAvailableProviders(names, count));
  return found;
}

/// The library has the provider but cannot start it: something of its own is missing.
void check_start(const Runtime& runtime, OrtStatus* status, const std::string& what) {
  const std::string reason = runtime.take_message(status);
  if (reason.empty()) return;
  throw OnnxError(UNISIM_ONNX_NO_RUNTIME,
                  what + ": " + reason + "; install what it lacks, or take provider cpu");
}

void append_cuda(const Runtime& runtime, const RunOptions& options, const std::string& what,
                 OrtSessionOptions* session) {
  OrtCUDAProviderOptionsV2* cuda = nullptr;
  check_start(runtime, runtime.api().CreateCUDAProviderOptions(&cuda), what);
  const std::string limit = std::to_string(options.memory_bytes);
  const char* const keys[] = {"gpu_mem_limit", "arena_extend_strategy"};
  const char* const values[] = {limit.c_str(), "kSameAsRequested"};
  OrtStatus* status = runtime.api().UpdateCUDAProviderOptions(cuda, keys, values, 2);
  if (status == nullptr) {
    status = runtime.api().SessionOptionsAppendExecutionProvider_CUDA_V2(session, cuda);
  }
  runtime.api().ReleaseCUDAProviderOptions(cuda);
  check_start(runtime, status, what);
}

void append_tensorrt(const Runtime& runtime, const std::string& what, OrtSessionOptions* session) {
  OrtTensorRTProviderOptionsV2* tensorrt = nullptr;
  check_start(runtime, runtime.api().CreateTensorRTProviderOptions(&tensorrt), what);
  OrtStatus* status =
      runtime.api().SessionOptionsAppendExecutionProvider_TensorRT_V2(session, tensorrt);
  runtime.api().ReleaseTensorRTProviderOptions(tensorrt);
  check_start(runtime, status, what);
}

}  // namespace

void append_provider(const Runtime& runtime, const RunOptions& options,
                     OrtSessionOptions* session) {
  if (options.provider == "cpu") return;
  const std::string what = "provider " + options.provider + " of " + runtime.name();
  const std::vector<std::string> offered = available(runtime);
  const auto same = [&](const std::string& name) { return lower(name) == options.provider; };
  const auto found = std::find_if(offered.begin(), offered.end(), same);
  if (found == offered.end()) {
    std::string list;
    for (const std::string& name : offered) list += " " + lower(name);
    throw OnnxError(UNISIM_ONNX_NO_RUNTIME,
                    what + ": not in this library, which has" + list +
                        "; take one of these or name a library built with it");
  }
  if (options.provider == "cuda") return append_cuda(runtime, options, what, session);
  if (options.provider == "tensorrt") {
    append_tensorrt(runtime, what, session);
    // What TensorRT does not know runs on CUDA, not on the CPU.
    return append_cuda(runtime, options, what, session);
  }
  check_start(runtime,
              runtime.api().SessionOptionsAppendExecutionProvider(session, found->c_str(), nullptr,
                                                                  nullptr, 0),
              what);
}

}  // namespace unisim::onnx
