// SPDX-License-Identifier: MIT
// Images that another program sends over LCM, as the camera of a live run.
#include "tools/live/lcm_images.hpp"

#include "drivers/lcm/subscriber.h"
#include "tools/common/failure.hpp"

namespace unisim::live {

std::string udpm_url(const std::string& device) {
  const std::string rest = device.substr(std::string(kLcmScheme).size());
  return rest.empty() ? "" : "udpm://" + rest;
}

int exit_code_of_lcm(int32_t problem) {
  const bool usage = problem == UNISIM_LCM_BAD_CONFIG || problem == UNISIM_LCM_NOT_BUILT;
  return usage ? tools::kExitUsage : tools::kExitLimit;
}

replay::Input open_lcm_images(const Options& options) {
  const std::string url = udpm_url(options.device);
  unisim_lcm_subscriber_config config{};
  config.struct_size = sizeof config;
  config.url = url.c_str();
  config.channel = options.image_channel.c_str();
  int32_t problem = UNISIM_LCM_OK;
  char message[1024] = "";
  replay::Input input;
  input.source.reset(unisim_lcm_subscribe(&config, &problem, message, sizeof message));
  if (input.source == nullptr) {
    throw tools::Failure(exit_code_of_lcm(problem), message);
  }
  for (int32_t k = 0; const char* note = unisim_lcm_subscriber_note(input.source.get(), k); ++k) {
    input.notes.emplace_back(note);
  }
  return input;
}

std::string lcm_losses(const unisim_source* source) {
  unisim_lcm_subscriber_counts counts{};
  counts.struct_size = sizeof counts;
  unisim_lcm_subscriber_get_counts(source, &counts);
  std::string text;
  if (counts.passed_over > 0) {
    text = std::to_string(counts.passed_over) + " of " + std::to_string(counts.received) +
           " dropped for newer ones";
  }
  if (counts.foreign > 0) {
    text += (text.empty() ? "" : ", ") + std::to_string(counts.foreign) +
            " messages that were no image";
  }
  return text;
}

}  // namespace unisim::live
