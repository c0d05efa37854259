// SPDX-License-Identifier: MIT
// Sources and predictors that free themselves.
#pragma once

#include <memory>

#include "drivers/predictor.h"
#include "drivers/source.h"

namespace unisim::drivers {

struct Destroy {
  void operator()(unisim_source* source) const { source->destroy(source); }
  void operator()(unisim_predictor* predictor) const { predictor->destroy(predictor); }
};
using SourcePtr = std::unique_ptr<unisim_source, Destroy>;
using PredictorPtr = std::unique_ptr<unisim_predictor, Destroy>;

}  // namespace unisim::drivers
