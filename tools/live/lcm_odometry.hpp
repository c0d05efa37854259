// SPDX-License-Identifier: MIT
// Odometry that comes over LCM while a live run goes.
#pragma once

#include <memory>
#include <string>

#include "drivers/lcm/odometry_listener.hpp"
#include "tools/live/options.hpp"

namespace unisim::live {

/// Where it is listened to: with the images of --device lcm://, else where the run publishes,
/// unless that is a file; "" for the usual address.
std::string odometry_url(const Options& options);

/// Listens on the channel of --odometry. Throws Failure.
std::unique_ptr<lcm::OdometryListener> open_odometry(const Options& options,
                                                     pipeline::DistanceInbox* inbox);

/// What was wrong with it, "" for nothing: for the end of the run.
std::string odometry_losses(const Options& options, const lcm::OdometryCounts& counts);

}  // namespace unisim::live
