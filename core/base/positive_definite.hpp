// SPDX-License-Identifier: MIT
// Inverse and solve for symmetric positive definite 7x7 matrices.
#pragma once

#include "core/base/eigen_types.hpp"

namespace unisim {

// Written out, by Cholesky's factor: the like of Eigen holds branches that ask the heap, and
// whether they are left out of the object is up to the compiler. Of A the lower triangle is read.
// Where A is not positive definite, or not finite, results are NaN.

bool is_positive_definite(const Mat7& A);
/// A^-1, symmetric to the last bit.
Mat7 inverse_of_positive(const Mat7& A);
/// A^-1 b
Vec7 solve_positive(const Mat7& A, const Vec7& b);

}  // namespace unisim
