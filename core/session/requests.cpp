// SPDX-License-Identifier: MIT
// Requests that the host turns down.
#include "core/session.hpp"

namespace unisim {

Status Session::reject_request(const Request& request) {
  if (!requests_.wants(request)) return Status::kInvalidArgument;
  const Window& asked = request.keyframes;
  if (request.kind == kRequestPair) {
    refuse_pair(asked.last(), RefusalReason::kHost);
    return Status::kOk;
  }
  int32_t index = -1;
  if (!holds(requests_.find_window(asked.first, asked.last(), &index))) return Status::kInternal;
  refuse_window(requests_.take_window(index), RefusalReason::kHost);
  return Status::kOk;
}

}  // namespace unisim
