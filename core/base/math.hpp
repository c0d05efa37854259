// SPDX-License-Identifier: MIT
// Elementary functions that give the same bits on every machine.
#pragma once

namespace unisim {
namespace math {

// The system's libm chooses other sums where the processor fuses multiply and add. These use plain
// operations in a fixed order (IEEE doubles, no contraction) and err by 2 units of the last digit
// at most. sqrt, floor and ldexp are exact everywhere and are taken from the system.

double exp(double x);
/// e^x - 1, accurate near 0.
double expm1(double x);
double log(double x);
/// To about the precision of float.
float log(float x);
/// NaN beyond |x| = 1e9; absolute error grows like 1e-26 |x|.
void sin_cos(double x, double* sine, double* cosine);
/// Angle in [0, pi / 2] of the vector (x, y), both >= 0 and one of them > 0.
double first_quadrant_angle(double x, double y);

}  // namespace math
}  // namespace unisim
