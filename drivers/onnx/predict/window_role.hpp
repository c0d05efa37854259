// SPDX-License-Identifier: MIT
// The windows of a model; a refused one is tried again without the views that are to blame.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "drivers/onnx/predict/refused_pairs.hpp"
#include "drivers/onnx/predict/role.hpp"
#include "drivers/predictor.h"

namespace unisim::onnx {

class WindowRole {
 public:
  /// @param refused_pairs settled by the caller; must outlive this
  WindowRole(std::unique_ptr<Role> role, const RefusedPairs* refused_pairs)
      : role_(std::move(role)), refused_pairs_(refused_pairs) {}

  /// @param count 2..UNISIM_MAX_VIEWS ids, ascending
  Answer predict(const int32_t* ids, int32_t count);

  // Of the last prediction.
  int32_t count() const { return count_; }
  const int32_t* ids() const { return ids_.data(); }
  const Outputs& outputs() const { return role_->outputs(); }
  /// Views that were left out and why, "" when none were.
  const std::string& remark() const { return remark_; }

 private:
  std::unique_ptr<Role> role_;
  const RefusedPairs* refused_pairs_;
  std::array<int32_t, UNISIM_MAX_VIEWS> ids_{};
  int32_t count_ = 0;
  std::string remark_;
};

}  // namespace unisim::onnx
