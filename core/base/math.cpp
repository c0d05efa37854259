// SPDX-License-Identifier: MIT
// Elementary functions that give the same bits on every machine: reduce the argument, sum a series.
#include "core/base/math.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace unisim {
namespace math {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSqrtHalf = 0.70710678118654752;
constexpr double kLn2High = 0x1.62e42fefp-1;  // 33 bits: times an exponent it is exact
constexpr double kLn2Low = 0x1.473de6af278edp-34;
constexpr double kHalfPi = 0x1.921fb54442d18p+0;
constexpr double kHalfPi1 = 0x1.921fb544p+0;  // pi/2 in three parts, 33 bits each but the last
constexpr double kHalfPi2 = 0x1.0b4611a6p-34;
constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;

// atan(k / 8).
constexpr double kAtan[9] = {0.0,
                             0.12435499454676144,
                             0.24497866312686414,
                             0.35877067027057225,
                             0.4636476090008061,
                             0.5585993153435624,
                             0.6435011087932844,
                             0.7188299996216245,
                             0.7853981633974483};

constexpr int kExpTerms = 15;
constexpr int kLogTerms = 10;

// 1 / n.
struct Reciprocals {
  static constexpr int kLast = 2 * kLogTerms + 1;
  constexpr Reciprocals() {
    for (int n = 1; n <= kLast; ++n) of[n] = 1.0 / n;
  }
  double of[kLast + 1] = {};
};
constexpr Reciprocals kReciprocals;

int64_t nearest(double x) { return static_cast<int64_t>(x + (x < 0.0 ? -0.5 : 0.5)); }

// 2^exponent for a normal result.
double power_of_two(int64_t exponent) {
  const uint64_t bits = static_cast<uint64_t>(exponent + 1023) << 52;
  double out;
  std::memcpy(&out, &bits, sizeof out);
  return out;
}

// e^r - 1 for |r| < 0.5.
double expm1_series(double r) {
  double sum = 1.0;
  for (int n = kExpTerms; n >= 3; --n) sum = 1.0 + r * kReciprocals.of[n] * sum;
  return r + 0.5 * (r * r) * sum;
}

// x = m 2^exponent, m in [sqrt(1/2), sqrt(2)); x positive and normal.
double split(double x, int64_t* exponent) {
  uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  *exponent = static_cast<int64_t>(bits >> 52) - 1022;
  bits = (bits & 0xfffffffffffffU) | (uint64_t{1022} << 52);
  double m;
  std::memcpy(&m, &bits, sizeof m);
  if (m < kSqrtHalf) {
    m *= 2.0;
    --*exponent;
  }
  return m;
}

// log of m in [sqrt(1/2), sqrt(2)] in `terms` terms of the series of atanh.
double log_series(double m, int terms) {
  const double y = (m - 1.0) / (m + 1.0);
  const double y2 = y * y;
  double sum = 0.0;
  for (int k = terms; k >= 1; --k) sum = y2 * (kReciprocals.of[2 * k + 1] + sum);
  return 2.0 * y + 2.0 * y * sum;
}

}  // namespace

double exp(double x) {
  if (x != x) return x;
  if (x > 709.782712893384) return kInfinity;
  if (x < -745.2) return 0.0;
  const int64_t k = nearest(x * 1.4426950408889634);
  const double r = (x - static_cast<double>(k) * kLn2High) - static_cast<double>(k) * kLn2Low;
  const int64_t half = k / 2;
  return (1.0 + expm1_series(r)) * power_of_two(half) * power_of_two(k - half);
}

double expm1(double x) { return std::abs(x) < 0.5 ? expm1_series(x) : exp(x) - 1.0; }

double log(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -kInfinity : kNaN;
  if (x == kInfinity) return x;
  constexpr int64_t kScaleBits = 54;
  const bool subnormal = x < std::numeric_limits<double>::min();
  int64_t exponent;
  const double m = split(subnormal ? x * power_of_two(kScaleBits) : x, &exponent);
  const double e = static_cast<double>(subnormal ? exponent - kScaleBits : exponent);
  return e * kLn2High + (log_series(m, kLogTerms) + e * kLn2Low);
}

float log(float x) {
  if (!(x > 0.0F) || x == std::numeric_limits<float>::infinity()) {
    return static_cast<float>(log(static_cast<double>(x)));
  }
  int64_t exponent;
  const double m = split(static_cast<double>(x), &exponent);
  return static_cast<float>(static_cast<double>(exponent) * (kLn2High + kLn2Low) +
                            log_series(m, 5));
}

void sin_cos(double x, double* sine, double* cosine) {
  if (!(std::abs(x) <= 1e9)) {
    *sine = *cosine = kNaN;
    return;
  }
  const int64_t k = nearest(x / kHalfPi);
  const double n = static_cast<double>(k);
  const double r = ((x - n * kHalfPi1) - n * kHalfPi2) - n * kHalfPi3;
  const double r2 = r * r;
  double s = 0.0;
  double c = 0.0;
  for (int i = 17; i >= 3; i -= 2) {
    s = (1.0 + s) * (-r2 / (i * (i - 1)));
    c = (1.0 + c) * (-r2 / ((i - 1) * (i - 2)));
  }
  s = r + r * s;
  c = 1.0 + c;
  switch (k & 3) {
    case 0:
      *sine = s, *cosine = c;
      break;
    case 1:
      *sine = c, *cosine = -s;
      break;
    case 2:
      *sine = -s, *cosine = -c;
      break;
    default:
      *sine = -c, *cosine = s;
  }
}

double first_quadrant_angle(double x, double y) {
  const bool steep = y > x;
  const double low = steep ? x : y;
  const double high = steep ? y : x;
  const int64_t k = nearest(8.0 * (low / high));
  if (k < 0 || k > 8) return kNaN;
  const double c = static_cast<double>(k) * 0.125;
  const double u = (low - c * high) / (high + c * low);  // |u| <= 1/16
  const double u2 = u * u;
  double sum = 0.0;
  for (int i = 8; i >= 1; --i) sum = -u2 * (1.0 / (2 * i + 1) + sum);
  const double angle = kAtan[k] + (u + u * sum);
  return steep ? kHalfPi - angle : angle;
}

}  // namespace math
}  // namespace unisim
