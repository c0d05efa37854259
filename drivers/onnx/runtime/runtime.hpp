// SPDX-License-Identifier: MIT
// ONNX Runtime, opened while the program runs: one build works with every version that is new
// enough.
#pragma once

#include <onnxruntime_c_api.h>

#include <memory>
#include <string>

namespace unisim::onnx {

/// The oldest C API used; ONNX Runtime 1.N has API N and all older ones.
inline constexpr uint32_t kApiVersion = 21;
static_assert(ORT_API_VERSION >= kApiVersion, "onnxruntime_c_api.h is older than 1.21");

/// An open library with its environment. Never closed: its threads may outlive any of its users.
class Runtime {
 public:
  /// The library of this path or, for "", the first found: environment UNISIM_ORT_LIB, the folder
  /// filled by tools/bootstrap.sh, the system's libonnxruntime.so.1.
  /// @throws OnnxError (UNISIM_ONNX_NO_RUNTIME)
  static std::shared_ptr<const Runtime> open(const std::string& path);

  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  const OrtApi& api() const { return *api_; }
  const OrtEnv& env() const { return *env_; }
  /// "ONNX Runtime 1.31.1 (PATH)"
  const std::string& name() const { return name_; }

  /// What a status says, in one line; releases it. "" for success (NULL).
  std::string take_message(OrtStatus* status) const;
  /// @throws OnnxError (problem) "what: the library's words"
  void check(OrtStatus* status, int32_t problem, const std::string& what) const;

 private:
  Runtime() = default;

  const OrtApi* api_ = nullptr;
  OrtEnv* env_ = nullptr;
  std::string name_;
};

}  // namespace unisim::onnx
