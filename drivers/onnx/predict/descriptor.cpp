// SPDX-License-Identifier: MIT
// Models of kind descriptor: one image in, one vector of unit length out.
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "drivers/onnx/creation.hpp"
#include "drivers/onnx/image/preprocessor.hpp"
#include "drivers/onnx/model/model.hpp"
#include "drivers/onnx/onnx.h"

struct unisim_onnx_descriptor {
  std::unique_ptr<unisim::onnx::Model> model;
  std::unique_ptr<unisim::onnx::Preprocessor> preprocessor;
  std::vector<float> values;
  std::string message;
};

namespace {

// Shorter than this is no direction.
constexpr double kMinLength = 1e-6;

int embed(unisim_onnx_descriptor* me, const unisim_image& image) {
  if (image.data == nullptr ||
      (image.format != UNISIM_PIXEL_GRAY8 && image.format != UNISIM_PIXEL_BGR8)) {
    me->message = "image is empty or neither gray nor BGR; frame left out";
    return UNISIM_PREDICTION_REJECTED;
  }
  if (me->preprocessor == nullptr) {
    me->preprocessor = std::make_unique<unisim::onnx::Preprocessor>(me->model->contract(),
                                                                    image.width, image.height);
  }
  const unisim::onnx::Framing& framing = me->preprocessor->framing();
  if (image.width != framing.image_width || image.height != framing.image_height) {
    me->message = "image size changed; frame left out";
    return UNISIM_PREDICTION_REJECTED;
  }
  me->preprocessor->run(image, me->model->input(0));
  me->message = me->model->run(1);
  if (!me->message.empty()) return UNISIM_PREDICTION_FAILED;
  double squares = 0;
  for (const float value : me->model->descriptor()) squares += double{value} * double{value};
  const double length = std::sqrt(squares);
  if (!(length > kMinLength) || !std::isfinite(length)) {
    me->message = "descriptor is not finite or has no length";
    return UNISIM_PREDICTION_REJECTED;
  }
  for (size_t i = 0; i < me->values.size(); ++i) {
    me->values[i] = static_cast<float>(double{me->model->descriptor()[i]} / length);
  }
  return UNISIM_PREDICTION_OK;
}

}  // namespace

unisim_onnx_descriptor* unisim_onnx_descriptor_open(const unisim_onnx_config* config,
                                                    const char* path, int32_t* problem,
                                                    char* message, size_t capacity) {
  namespace o = unisim::onnx;
  return o::create(problem, message, capacity, [&]() {
    const o::RunOptions run = o::read_run_options(*config);
    auto made = std::make_unique<unisim_onnx_descriptor>();
    made->model = std::make_unique<o::Model>(o::Runtime::open(run.library), path, run);
    if (made->model->contract().kind != o::Kind::kDescriptor) {
      throw o::OnnxError(UNISIM_ONNX_BAD_MODEL,
                         std::string(path) + ": is not of kind descriptor; give one that is");
    }
    o::MemoryBudget budget;
    budget.bytes = run.memory_bytes;
    made->model->warm_up(1, 1, budget);
    made->values.resize(made->model->descriptor().size());
    return made.release();
  });
}

int32_t unisim_onnx_descriptor_size(const unisim_onnx_descriptor* descriptor) {
  return static_cast<int32_t>(descriptor->values.size());
}

int unisim_onnx_descriptor_embed(unisim_onnx_descriptor* descriptor, const unisim_image* image,
                                 const float** values) {
  try {
    const int status = embed(descriptor, *image);
    if (status == UNISIM_PREDICTION_OK) *values = descriptor->values.data();
    return status;
  } catch (const std::exception& error) {
    descriptor->message = error.what();
    return UNISIM_PREDICTION_FAILED;
  }
}

const char* unisim_onnx_descriptor_message(const unisim_onnx_descriptor* descriptor) {
  return descriptor->message.c_str();
}

void unisim_onnx_descriptor_close(unisim_onnx_descriptor* descriptor) { delete descriptor; }
