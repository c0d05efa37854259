// SPDX-License-Identifier: MIT
// --lcm: the run is told over LCM as it goes.
#pragma once

#include <memory>
#include <string>

#include "drivers/lcm/session_publisher.hpp"
#include "tools/replay/options.hpp"

namespace unisim::replay {

/// Nothing where --lcm is not given.
class LcmOutput {
 public:
  /// Throws Failure when the URL is no good (2) or its network is not there (4).
  explicit LcmOutput(const Options& options);

  /// NULL without --lcm.
  pipeline::Listener* listener() { return listener_.get(); }

  /// To be called between the making of the pipeline and its run().
  void attach(const pipeline::Pipeline& pipeline);
  /// After the run, while the session is there: what is left to say. Waits up to a second.
  void finish();

  /// Messages that did not go out, a line; "" if all did.
  const std::string& problem() const { return problem_; }

 private:
  struct Destroy {
    void operator()(unisim_lcm_publisher* publisher) const {
      unisim_lcm_publisher_destroy(publisher);
    }
  };
  std::unique_ptr<unisim_lcm_publisher, Destroy> publisher_;
  std::unique_ptr<lcm::SessionPublisher> listener_;
  std::string problem_;
};

}  // namespace unisim::replay
