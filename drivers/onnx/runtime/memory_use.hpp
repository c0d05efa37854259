// SPDX-License-Identifier: MIT
// Memory of the machine and of this process, as Linux tells it.
#pragma once

#include <cstdint>
#include <functional>

namespace unisim::onnx {

/// Main memory of the machine, or what the process's control group may have where that is less.
int64_t machine_memory_bytes();

/// Most memory `work` made the process hold beyond what it held before; 0 where it is not known.
int64_t peak_growth_bytes(const std::function<void()>& work);

/// Most memory this process held before peak_growth_bytes() last reset the system's mark of it.
int64_t peak_before_reset_bytes();

/// Largest number of views, first <= V <= wanted, whose inference stays within the budget.
/// Measured, never tried beyond what the last measurement allows: memory grows with V^2 at most
/// (attention over all views).
/// @param measure runs V views, returns the bytes that took
/// @return `first` also when that is beyond the budget
int32_t views_within(int64_t budget, int32_t first, int32_t wanted,
                     const std::function<int64_t(int32_t)>& measure);

}  // namespace unisim::onnx
