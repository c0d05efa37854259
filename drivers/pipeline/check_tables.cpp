// SPDX-License-Identifier: MIT
// Are the tables of a source and a predictor ones that this library knows?
#include "drivers/pipeline/check_tables.hpp"

#include <cstddef>
#include <string>

namespace unisim::pipeline {

Preparation check_tables(const unisim_source& source, const unisim_predictor& predictor) {
  const auto refuse = [](const std::string& why) {
    return Preparation{Preparation::Answer::kBadConfiguration, why};
  };
  const char* const sizes = ": struct_size is not one this library knows; set it to sizeof";
  if (source.struct_size < sizeof source) return refuse(std::string("source") + sizes);
  if (predictor.struct_size < offsetof(unisim_predictor, place_descriptor))
    return refuse(std::string("predictor") + sizes);
  if (predictor.concurrent_windows != 0 && predictor.window_message == nullptr) {
    return refuse(std::string(predictor.name) +
                  " predictor: concurrent_windows needs a window_message()");
  }
  return {};
}

}  // namespace unisim::pipeline
