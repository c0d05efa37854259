// SPDX-License-Identifier: MIT
// A network of the test's own.
#include "tests/lcm/own_network.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace unisim::testing {
namespace {

std::string reason(const char* what) { return std::string(what) + ": " + std::strerror(errno); }

void set_address(sockaddr* out, const char* text) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  inet_pton(AF_INET, text, &address.sin_addr);
  std::memcpy(out, &address, sizeof address);
}

std::string raise_loopback(int any_socket) {
  ifreq device{};
  std::strcpy(device.ifr_name, "lo");
  if (ioctl(any_socket, SIOCGIFFLAGS, &device) != 0) return reason("loopback");
  device.ifr_flags = static_cast<short>(device.ifr_flags | IFF_UP);
  return ioctl(any_socket, SIOCSIFFLAGS, &device) == 0 ? "" : reason("loopback");
}

std::string add_route(int any_socket) {
  rtentry route{};
  char device[] = "lo";
  set_address(&route.rt_dst, "224.0.0.0");
  set_address(&route.rt_genmask, "240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = device;
  return ioctl(any_socket, SIOCADDRT, &route) == 0 ? "" : reason("route");
}

}  // namespace

std::string enter_own_network(bool route) {
  // Without rights a network comes with a user of its own.
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return reason("unshare");
  }
  const int any_socket = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (any_socket < 0) return reason("socket");
  std::string why_not = raise_loopback(any_socket);
  if (why_not.empty() && route) why_not = add_route(any_socket);
  close(any_socket);
  return why_not;
}

}  // namespace unisim::testing
