// SPDX-License-Identifier: MIT
// --web: a page on the robot that shows the run as it goes.
#include "tools/live/web/output.hpp"

#include <filesystem>
#include <system_error>

#include "tools/live/web/address.hpp"
#include "tools/live/web/feed.hpp"
#include "tools/live/web/server.hpp"
#include "tools/live/web/view_listener.hpp"

namespace unisim::live::web {
namespace {

/// Old poses go on disk, beside the results or with the temporary files.
std::string folder_of_poses(const Options& options) {
  if (!options.run.out.empty()) return options.run.out;
  std::error_code none;
  return std::filesystem::temp_directory_path(none).string();
}

}  // namespace

class Output::Impl {
 public:
  Impl(const Options& options, const PoseAge* ages)
      : feed_(options.run.sequence),
        listener_(&feed_, ages, folder_of_poses(options)),
        server_(&feed_, parse_address(*options.web, !options.web_token.empty()),
                options.web_token) {}

  ViewListener& listener() { return listener_; }
  const Server& server() const { return server_; }

 private:
  Feed feed_;
  ViewListener listener_;
  Server server_;
};

Output::Output(const Options& options, const PoseAge* ages) {
  if (options.web) impl_ = std::make_unique<Impl>(options, ages);
}

Output::~Output() = default;

pipeline::Listener* Output::listener() { return impl_ ? &impl_->listener() : nullptr; }

std::string Output::note() const {
  return impl_ ? "page: " + impl_->server().url() : std::string();
}

void Output::attach(const pipeline::Pipeline& pipeline, unisim_predictor* predictor) {
  if (impl_) impl_->listener().attach(&pipeline, predictor);
}

}  // namespace unisim::live::web
