// SPDX-License-Identifier: MIT
// The windows of a model; a refused one is tried again without the views that are to blame.
#include "drivers/onnx/predict/window_role.hpp"

#include <algorithm>

namespace unisim::onnx {
namespace {

// A window of fewer says nothing.
constexpr int32_t kFewestViews = 2;

}  // namespace

Answer WindowRole::predict(const int32_t* ids, int32_t count) {
  remark_.clear();
  count_ = count;
  std::copy_n(ids, count, ids_.begin());
  Answer answer = role_->predict(ids, count);
  const std::string reason = answer.problem;
  for (const RefusedPairs::Blame blame : RefusedPairs::kBlames) {
    if (answer.problem.empty() || answer.run_failed) return answer;
    const auto blamed = [&](int32_t id) {
      return refused_pairs_->blamed(id, blame, ids[count - 1]);
    };
    const auto end = std::remove_copy_if(ids, ids + count, ids_.begin(), blamed);
    count_ = static_cast<int32_t>(end - ids_.begin());
    if (count_ == count || count_ < kFewestViews) continue;
    answer = role_->predict(ids_.data(), count_);
    if (!answer.problem.empty()) continue;
    remark_ = "taken without";
    for (const int32_t* id = ids; id != ids + count; ++id) {
      if (blamed(*id)) remark_ += " " + std::to_string(*id);
    }
    remark_ += ": " + reason;
  }
  return answer;
}

}  // namespace unisim::onnx
