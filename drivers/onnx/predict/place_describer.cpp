// SPDX-License-Identifier: MIT
// What a keyframe looks like as a whole.
#include "drivers/onnx/predict/place_describer.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/common/image_mat.hpp"
#include "drivers/geometric/places/orb.hpp"
#include "drivers/geometric/places/vlad.hpp"
#include "drivers/predictor.h"

namespace unisim::onnx {
namespace {

// Numbers of a unit vector of d dimensions have a standard deviation of 1/sqrt(d): four of them
// reach the limit of int8.
constexpr double kReach = 4.0;
constexpr double kLargest = 127.0;

// The detector of features leaves a border of 19 pixels out.
constexpr int32_t kLeastSide = 40;

}  // namespace

struct PlaceDescriber::Features {
  geometric::Orb orb;
  geometric::OrbFeatureSet found;
  cv::Mat gray;
};

PlaceDescriber::PlaceDescriber(unisim_onnx_descriptor* model) : model_(model) {
  if (model_ != nullptr) {
    values_.resize(static_cast<size_t>(unisim_onnx_descriptor_size(model_)));
    return;
  }
  features_ = std::make_unique<Features>();
  values_.resize(geometric::kVladSize);
}

PlaceDescriber::~PlaceDescriber() { unisim_onnx_descriptor_close(model_); }

int PlaceDescriber::describe(const unisim_image& image) {
  return model_ != nullptr ? by_model(image) : by_features(image);
}

int PlaceDescriber::by_model(const unisim_image& image) {
  const float* unit = nullptr;
  const int status = unisim_onnx_descriptor_embed(model_, &image, &unit);
  if (status != UNISIM_PREDICTION_OK) {
    message_ = unisim_onnx_descriptor_message(model_);
    return status;
  }
  const double scale = kLargest / kReach * std::sqrt(static_cast<double>(values_.size()));
  for (size_t k = 0; k < values_.size(); ++k) {
    const double value = std::round(scale * double{unit[k]});
    values_[k] = static_cast<int8_t>(std::clamp(value, -kLargest, kLargest));
  }
  return status;
}

int PlaceDescriber::by_features(const unisim_image& image) {
  if (std::min(image.width, image.height) < kLeastSide) {
    message_ =
        "the image is too small to find it again by features; give a model of kind descriptor";
    return UNISIM_PREDICTION_REJECTED;
  }
  const cv::Mat seen = drivers::image_mat(image);
  if (image.format == UNISIM_PIXEL_GRAY8) {
    features_->gray = seen;
  } else {
    cv::cvtColor(seen, features_->gray, cv::COLOR_BGR2GRAY);
  }
  features_->orb.describe(features_->gray, &features_->found);
  features_->gray.release();
  if (geometric::describe_image(features_->found.descriptor, values_.data())) {
    return UNISIM_PREDICTION_OK;
  }
  message_ = "the image has no features to find it again by";
  return UNISIM_PREDICTION_REJECTED;
}

}  // namespace unisim::onnx
