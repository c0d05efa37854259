// SPDX-License-Identifier: MIT
// --lcm: the run is told over LCM as it goes.
#include "tools/replay/lcm_output.hpp"

#include <cstring>

#include "tools/common/failure.hpp"

namespace unisim::replay {
namespace {

constexpr size_t kLine = 1024;

int exit_code(int32_t problem) {
  const bool usage = problem == UNISIM_LCM_BAD_CONFIG || problem == UNISIM_LCM_NOT_BUILT;
  return usage ? tools::kExitUsage : tools::kExitLimit;
}

std::string describe(const unisim_lcm_publisher_counts& counts) {
  if (counts.failed == 0 && counts.dropped == 0) return "";
  return "lcm: of " + std::to_string(counts.queued) + " messages " + std::to_string(counts.failed) +
         " were refused by the network" +
         (counts.error_number != 0 ? std::string(" (") + std::strerror(counts.error_number) + ")"
                                   : "") +
         " and " + std::to_string(counts.dropped) +
         " dropped because it was slow; see that it is up, or send less";
}

}  // namespace

LcmOutput::LcmOutput(const Options& options) {
  if (!options.lcm) return;
  unisim_lcm_publisher_config config{};
  config.struct_size = sizeof config;
  config.requests = 1;
  config.url = options.lcm->c_str();
  int32_t problem = UNISIM_LCM_OK;
  char message[kLine] = "";
  publisher_.reset(unisim_lcm_publisher_create(&config, &problem, message, sizeof message));
  if (publisher_ == nullptr) throw tools::Failure(exit_code(problem), message);
  lcm::SessionPublisherOptions how;
  how.images = options.lcm_images;
  how.points_per_submap = options.lcm_points;
  how.folder = options.out;
  listener_ = std::make_unique<lcm::SessionPublisher>(publisher_.get(), how);
}

void LcmOutput::attach(const pipeline::Pipeline& pipeline) {
  if (listener_ != nullptr) listener_->attach(&pipeline);
}

void LcmOutput::finish() {
  if (listener_ == nullptr) return;
  listener_->finish();
  unisim_lcm_publisher_counts counts{};
  counts.struct_size = sizeof counts;
  unisim_lcm_publisher_flush(publisher_.get());
  unisim_lcm_publisher_get_counts(publisher_.get(), &counts);
  problem_ = describe(counts);
}

}  // namespace unisim::replay
