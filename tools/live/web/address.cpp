// SPDX-License-Identifier: MIT
// Where the page of a live run is served.
#include "tools/live/web/address.hpp"

#include <algorithm>

#include "tools/common/failure.hpp"

namespace unisim::live::web {
namespace {

tools::Failure wrong(const std::string& text, const char* why) {
  return {tools::kExitUsage, "--web " + text + ": " + why};
}

/// Splits ADDRESS:PORT; [IPV6] loses its brackets. @return false without a port
bool split(const std::string& text, std::string* host, std::string* port) {
  const size_t colon = text.rfind(':');
  if (colon == std::string::npos) return false;
  *host = text.substr(0, colon);
  *port = text.substr(colon + 1);
  if (host->size() > 2 && host->front() == '[' && host->back() == ']') {
    *host = host->substr(1, host->size() - 2);
  }
  return true;
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || host.rfind("127.", 0) == 0;
}

}  // namespace

Address parse_address(const std::string& text, bool with_token) {
  Address address;
  std::string port = text;
  if (split(text, &address.host, &port) && address.host.empty()) {
    throw wrong(text, "give PORT, or ADDRESS:PORT such as 0.0.0.0:8080");
  }
  const bool digits =
      !port.empty() && port.size() <= 5 &&
      std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
  constexpr int kLastPort = 65535;
  if (!digits || std::stoi(port) > kLastPort) {
    throw wrong(text, "the port must be a number from 0 (any that is free) to 65535");
  }
  address.port = std::stoi(port);
  if (!with_token && !is_loopback(address.host)) {
    throw wrong(
        text,
        "others than this machine could look; give --web-token a secret to ask them for, or "
        "the port alone");
  }
  return address;
}

bool names_this_machine(const std::string& host_header) {
  std::string host = host_header;
  std::string port;
  if (host_header.find(']') != std::string::npos || host_header.find(':') != std::string::npos) {
    if (host_header.back() == ']') {
      host = host_header.substr(1, host_header.size() - 2);
    } else {
      split(host_header, &host, &port);
    }
  }
  return is_loopback(host);
}

}  // namespace unisim::live::web
