// SPDX-License-Identifier: MIT
// Where the page of a live run is served.
#pragma once

#include <string>

namespace unisim::live::web {

struct Address {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any that is free
};

/// PORT, ADDRESS:PORT or [IPV6]:PORT. Throws Failure (2).
/// @param with_token a token is asked for: only then others than this machine may connect
Address parse_address(const std::string& text, bool with_token);

/// Whether a Host header names this machine as programs on it do. Pages of elsewhere that a browser
/// has been told to find here (DNS rebinding) name themselves.
bool names_this_machine(const std::string& host_header);

}  // namespace unisim::live::web
