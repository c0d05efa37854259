// SPDX-License-Identifier: MIT
// Tells when a predictor's focal length is hardly known from what was filmed.
#include "drivers/pipeline/focal_doubt.hpp"

#include <cmath>

namespace unisim::pipeline {

namespace {
// Standard deviation over focal length. Films that tell it stay below 0.04, rooms with hardly a
// corner reach 0.07 and are off by up to 0.1; straight drives and posters begin at 0.2.
constexpr double kDoubtful = 0.08;
}  // namespace

std::string focal_doubt(const unisim_predictor_info& info) {
  if (!(info.focal_px > 0.0)) return {};
  const double share = info.focal_sigma_px / info.focal_px;
  if (!(share > kDoubtful)) return {};
  return "focal length " + std::to_string(std::lround(info.focal_px)) + " px is uncertain by " +
         std::to_string(std::lround(100.0 * share)) +
         " %: what was filmed hardly tells it, and lengths along the view stretch with it; give it "
         "if you know it, or turn the camera while it moves";
}

}  // namespace unisim::pipeline
