// SPDX-License-Identifier: MIT
// Search and opening of the library.
#include "drivers/onnx/runtime/runtime.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "drivers/onnx/error.hpp"

namespace unisim::onnx {
namespace {

constexpr const char* kSystemLibrary = "libonnxruntime.so.1";
constexpr const char* kHowToGet =
    "run tools/bootstrap.sh deps, or name a libonnxruntime of 1.21 or newer by option or "
    "UNISIM_ORT_LIB";

[[noreturn]] void fail(const std::string& line) { throw OnnxError(UNISIM_ONNX_NO_RUNTIME, line); }

/// The library to open. A path somebody named is taken as it is, there or not.
std::string find_library(const std::string& path) {
  if (!path.empty()) return path;
  const char* named = std::getenv("UNISIM_ORT_LIB");
  if (named != nullptr && *named != '\0') return named;
  const std::string fetched = std::string(UNISIM_ORT_FOLDER "/") + kSystemLibrary;
  std::error_code ignored;
  return std::filesystem::exists(fetched, ignored) ? fetched : kSystemLibrary;
}

const OrtApiBase* open_library(const std::string& path) {
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* reason = dlerror();
    fail("ONNX Runtime: " + std::string(reason != nullptr ? reason : path) + "; " + kHowToGet);
  }
  using GetApiBase = const OrtApiBase* (*)();
  const auto get = reinterpret_cast<GetApiBase>(dlsym(library, "OrtGetApiBase"));
  const OrtApiBase* base = get != nullptr ? get() : nullptr;
  if (base == nullptr) fail(path + ": is no ONNX Runtime; " + kHowToGet);
  return base;
}

}  // namespace

std::shared_ptr<const Runtime> Runtime::open(const std::string& path) {
  const std::string library = find_library(path);
  const OrtApiBase* base = open_library(library);
  const std::string version = base->GetVersionString();
  std::shared_ptr<Runtime> runtime(new Runtime);
  runtime->api_ = base->GetApi(kApiVersion);
  runtime->name_ = "ONNX Runtime " + version + " (" + library + ")";
  if (runtime->api_ == nullptr) fail(runtime->name_ + ": is older than 1.21; " + kHowToGet);
  // Its own log would mix with our lines; what matters comes back as a status.
  runtime->check(runtime->api_->CreateEnv(ORT_LOGGING_LEVEL_FATAL, "unisim", &runtime->env_),
                 UNISIM_ONNX_NO_RUNTIME, runtime->name_);
  return runtime;
}

Runtime::~Runtime() {
  if (env_ != nullptr) api_->ReleaseEnv(env_);
}

std::string Runtime::take_message(OrtStatus* status) const {
  if (status == nullptr) return "";
  std::string line = api_->GetErrorMessage(status);
  api_->ReleaseStatus(status);
  std::replace(line.begin(), line.end(), '\n', ' ');
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line.empty() ? "unknown error" : line;
}

void Runtime::check(OrtStatus* status, int32_t problem, const std::string& what) const {
  const std::string line = take_message(status);
  if (!line.empty()) throw OnnxError(problem, what + ": " + line);
}

}  // namespace unisim::onnx
