// SPDX-License-Identifier: MIT
// --web where the library for HTTP was not there when this was built.
#include "tools/common/failure.hpp"
#include "tools/live/web/output.hpp"

namespace unisim::live::web {

class Output::Impl {};

Output::Output(const Options& options, const PoseAge* /*ages*/) {
  if (!options.web) return;
  throw tools::Failure(tools::kExitUsage,
                       "--web: not in this build; install libcpp-httplib-dev and build again");
}

Output::~Output() = default;

pipeline::Listener* Output::listener() { return nullptr; }

std::string Output::note() const { return ""; }

void Output::attach(const pipeline::Pipeline& /*pipeline*/, unisim_predictor* /*predictor*/) {}

}  // namespace unisim::live::web
