// SPDX-License-Identifier: MIT
// A publisher that writes into a log of its own, and numbers to send.
#pragma once

#include <memory>
#include <string>

#include "drivers/lcm/publisher.h"
#include "tests/support/temp_folder.hpp"

namespace unisim::testing {

struct DestroyPublisher {
  void operator()(unisim_lcm_publisher* publisher) const {
    unisim_lcm_publisher_destroy(publisher);
  }
};
using PublisherPtr = std::unique_ptr<unisim_lcm_publisher, DestroyPublisher>;

/// NULL with `problem` and `message` where it cannot be made.
struct Made {
  PublisherPtr publisher;
  int32_t problem = -1;
  std::string message;
};
Made make_publisher(const std::string& url, int32_t unit = UNISIM_LCM_UNIT_RELATIVE,
                    int32_t requests = 0);

/// Publishes into a file until close().
class LoggedPublisher {
 public:
  explicit LoggedPublisher(int32_t unit = UNISIM_LCM_UNIT_RELATIVE);
  unisim_lcm_publisher* get() { return publisher_.get(); }
  /// @return path of the log, complete
  std::string close();

 private:
  TempFolder folder_;
  PublisherPtr publisher_;
};

/// 0.5 about z, translation 1 2 3, scale 2.
unisim_sim3 some_pose();
unisim_pose some_keyframe(int32_t id);

}  // namespace unisim::testing
