// SPDX-License-Identifier: MIT
// Scalar coefficients of the matrix functions of sigma I + hat(phi).
#pragma once

namespace unisim {

/// sin and cos in forms that stay accurate down to theta = 0, from theta2 = theta^2.
struct AngleTerms {
  double cosine;
  double sinc;       ///< sin(theta) / theta
  double versine;    ///< (1 - cos(theta)) / theta^2
  double d_sinc;     ///< (d sinc / d theta) / theta
  double d_versine;  ///< (d versine / d theta) / theta
};
AngleTerms angle_terms(double theta2);

/// V = A I + B K + C K^2 with t = V rho in exp; K = hat(phi).
struct ExpCoefficients {
  double A;
  double B;
  double C;
};
ExpCoefficients exp_coefficients(double theta2, double sigma);

/// V^-1 = a I + b K + c K^2 and its derivatives.
///
/// The function is g(z) = z / (e^z - 1) on the spectrum {sigma, sigma +- i theta}:
/// a = g(sigma), b = Im g / theta, c = (g(sigma) - Re g) / theta^2.
struct LogCoefficients {
  double a, b, c;
  double a_sigma, b_sigma, c_sigma;  ///< derivatives by sigma
  double b_theta, c_theta;           ///< derivatives by theta, divided by theta
  double c_rotation;                 ///< c at sigma = 0, for J_so3^-1 = I - K/2 + c K^2
};
LogCoefficients log_coefficients(double theta2, double sigma);

}  // namespace unisim
