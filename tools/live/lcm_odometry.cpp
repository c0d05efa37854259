// SPDX-License-Identifier: MIT
// Odometry that comes over LCM while a live run goes.
#include "tools/live/lcm_odometry.hpp"

#include "drivers/lcm/error.hpp"
#include "tools/common/failure.hpp"
#include "tools/live/lcm_images.hpp"

namespace unisim::live {

std::string odometry_url(const Options& options) {
  if (is_lcm(options.device)) return udpm_url(options.device);
  const std::string published = options.run.lcm.value_or("");
  return published.rfind("file:", 0) == 0 ? "" : published;
}

std::unique_ptr<lcm::OdometryListener> open_odometry(const Options& options,
                                                     pipeline::DistanceInbox* inbox) {
  const lcm::OdometryListenerConfig config = {odometry_url(options), options.odometry_channel,
                                              options.run.odometry_common.value_or(0.0)};
  try {
    return std::make_unique<lcm::OdometryListener>(config, inbox);
  } catch (const lcm::LcmError& error) {
    throw tools::Failure(exit_code_of_lcm(error.problem()),
                         std::string("--odometry: ") + error.what());
  }
}

std::string odometry_losses(const Options& options, const lcm::OdometryCounts& counts) {
  std::string text;
  const auto add = [&text](int64_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  if (counts.taken == 0) {
    text = "no pose came; see that the odometer sends bot_core.pose_t on this channel";
  }
  add(counts.foreign, "messages that were no pose_t");
  add(counts.refused, "poses that were not later than the one before");
  return text.empty() ? "" : "odometry on channel '" + options.odometry_channel + "': " + text;
}

}  // namespace unisim::live
