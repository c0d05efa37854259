// SPDX-License-Identifier: MIT
// The newest keyframes as one model wants them.
#include "drivers/onnx/predict/views.hpp"

#include <algorithm>

namespace unisim::onnx {

Views::Views(const Contract& contract, std::shared_ptr<Encoder> encoder, int64_t view_floats,
             int32_t capacity)
    : contract_(contract),
      encoder_(std::move(encoder)),
      capacity_(capacity),
      store_(capacity, view_floats),
      problems_(static_cast<size_t>(capacity)) {}

void Views::set_image_size(int32_t width, int32_t height) {
  preprocessor_.emplace(contract_, width, height);
}

Answer Views::add(int32_t id, const unisim_image& image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Answer answer = make(image, store_.add(id));
  problems_[place(id)] = answer.problem;
  return answer;
}

Answer Views::make(const unisim_image& image, float* view) {
  if (encoder_ == nullptr) {
    preprocessor_->run(image, view);
    return {};
  }
  preprocessor_->run(image, encoder_->input());
  Answer answer = encoder_->run();
  if (answer.problem.empty()) {
    std::copy(encoder_->features().begin(), encoder_->features().end(), view);
  }
  return answer;
}

/// What the model's input was, made again from the image.
std::string Views::restore(int32_t id, float* view) {
  const std::string name = "keyframe " + std::to_string(id);
  const unisim_image image = places_ != nullptr ? places_->find(id, &pixels_) : unisim_image{};
  if (image.data == nullptr) return name + " is not kept any more";
  const std::string problem = make(image, view).problem;
  return problem.empty() ? "" : name + " could not be encoded: " + problem;
}

std::string Views::copy(int32_t id, float* view) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const float* const kept = store_.find(id);
  if (kept == nullptr) return restore(id, view);
  const std::string& problem = problems_[place(id)];
  if (problem.empty()) {
    std::copy_n(kept, store_.view_floats(), view);
    return "";
  }
  return "keyframe " + std::to_string(id) + " could not be encoded: " + problem;
}

int64_t Views::bytes() const {
  return store_.bytes() + (preprocessor_ ? preprocessor_->bytes() : 0);
}

}  // namespace unisim::onnx
