// SPDX-License-Identifier: MIT
// Serves the page of a live run and its events over HTTP.
#pragma once

#include <memory>
#include <string>

#include "tools/live/web/address.hpp"
#include "tools/live/web/feed.hpp"

namespace unisim::live::web {

/// The page at /, the events at /events (server-sent events), to a few at a time. One who reads too
/// slowly is dropped; browsers come again by themselves.
class Server {
 public:
  /// Binds the port and begins. Throws Failure: it is taken or not allowed (4).
  /// @param feed borrowed
  /// @param token asked of every request as ?token=; "": none
  Server(Feed* feed, const Address& address, const std::string& token);
  /// Closes the feed and ends, with clients or without.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Of the page, with the port it got; without the token.
  const std::string& url() const { return url_; }

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
  std::string url_;
};

}  // namespace unisim::live::web
