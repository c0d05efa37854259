// SPDX-License-Identifier: MIT
// Opens what an LCM URL names.
#include "drivers/lcm/network.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "drivers/lcm/error.hpp"

namespace unisim::lcm {
namespace {

constexpr uint16_t kUsualPort = 7667;
constexpr const char* kUsualAddress = "239.255.76.67";
constexpr const char* kUsualServer = "127.0.0.1";  // of tcpq
constexpr const char* kUsualServerPort = "7700";
constexpr int kServerMs = 2000;

[[noreturn]] void refuse(const Url& url, const std::string& why) {
  throw LcmError(UNISIM_LCM_BAD_CONFIG, "URL '" + url.text + "': " + why);
}

/// A decimal number of at most `most`; -1 if it is not one.
int64_t number(const std::string& text, int64_t most) {
  if (text.empty() || text.size() > 10) return -1;
  if (text.find_first_not_of("0123456789") != std::string::npos) return -1;
  const int64_t value = std::stoll(text);
  return value <= most ? value : -1;
}

/// Address and port of udpm://, with LCM's own where one is not given.
sockaddr_in multicast_address(const Url& url) {
  const size_t colon = url.address.find(':');
  std::string host = url.address.substr(0, colon);
  if (host.empty()) host = kUsualAddress;
  int64_t port = kUsualPort;
  if (colon != std::string::npos && colon + 1 < url.address.size()) {
    port = number(url.address.substr(colon + 1), 65535);
  }
  sockaddr_in out{};
  out.sin_family = AF_INET;
  const bool good = inet_pton(AF_INET, host.c_str(), &out.sin_addr) == 1 &&
                    (ntohl(out.sin_addr.s_addr) >> 28) == 0xE && port > 0;
  if (!good) {
    refuse(url, "'" + url.address +
                    "' is no multicast address and port: give 224.0.0.0 to 239.255.255.255 and 1 "
                    "to 65535, such as 239.255.76.67:7667");
  }
  out.sin_port = htons(static_cast<uint16_t>(port));
  return out;
}

void take_network_option(const std::string& name, const std::string& value, Url* url) {
  const bool known = name == "ttl" || name == "recv_buf_size";
  if (!known) refuse(*url, "option '" + name + "' is not known: ttl and recv_buf_size are");
  const int64_t most = name == "ttl" ? 255 : INT32_MAX;
  const int64_t read = number(value, most);
  if (read < 0) {
    refuse(*url, name + "='" + value + "': give a number from 0 to " + std::to_string(most));
  }
  if (name == "recv_buf_size") url->receive_bytes = read;
}

void check_file(const Url& url, Direction direction, bool writes) {
  if (direction == Direction::kSubscribe) {
    refuse(url,
           "is a file: replay it with unisim-replay --format lcm, or play it with "
           "lcm-logplayer");
  }
  if (url.address.empty()) refuse(url, "names no file: give file:///PATH?mode=w");
  if (!writes) refuse(url, "would be read: give file://PATH?mode=w to write an event log");
}

/// All name=value pairs behind the question mark. @return whether mode=w was among them
bool take_options(const std::string& options, Url* url) {
  bool writes = false;
  for (size_t begin = 0; begin < options.size();) {
    const size_t end = std::min(options.find('&', begin), options.size());
    const std::string pair = options.substr(begin, end - begin);
    const size_t equals = std::min(pair.find('='), pair.size());
    const std::string name = pair.substr(0, equals);
    const std::string value = pair.substr(std::min(equals + 1, pair.size()));
    if (url->provider == "udpm") take_network_option(name, value, url);
    if (name == "mode" && value == "w") writes = true;
    begin = end + 1;
  }
  return writes;
}

/// liblcm says only NULL: asked for here, without a packet.
void check_route(const Url& url) {
  const sockaddr_in address = multicast_address(url);
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return;
  const int answer = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const int reason = errno;
  close(probe);
  if (answer == 0) return;
  throw LcmError(UNISIM_LCM_NO_NETWORK,
                 "no route for multicast to " + url.address + " (" + std::strerror(reason) +
                     "); for this machine alone run: ip link set lo up; ip route add 224.0.0.0/4 "
                     "dev lo");
}

/// Whether something listens there, within kServerMs. @return errno, 0: it does
int knock(const addrinfo& at) {
  const int probe = socket(at.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (probe < 0) return errno;
  int why = connect(probe, at.ai_addr, at.ai_addrlen) == 0 ? 0 : errno;
  if (why == EINPROGRESS) {
    pollfd waits = {probe, POLLOUT, 0};
    socklen_t size = sizeof why;
    if (poll(&waits, 1, kServerMs) != 1) {
      why = ETIMEDOUT;
    } else if (getsockopt(probe, SOL_SOCKET, SO_ERROR, &why, &size) != 0) {
      why = errno;
    }
  }
  close(probe);
  return why;
}

/// liblcm would try anew with each message, and print three lines for each.
void check_server(const Url& url) {
  const size_t colon = url.address.find(':');
  std::string host = url.address.substr(0, colon);
  std::string port = colon == std::string::npos ? "" : url.address.substr(colon + 1);
  if (host.empty()) host = kUsualServer;
  if (port.empty()) port = kUsualServerPort;
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unknown = getaddrinfo(host.c_str(), port.c_str(), &wanted, &found);
  const int why = unknown == 0 ? knock(*found) : 0;
  const std::string reason = unknown == 0 ? std::strerror(why) : gai_strerror(unknown);
  if (found != nullptr) freeaddrinfo(found);
  if (unknown == 0 && why == 0) return;
  throw LcmError(UNISIM_LCM_NO_NETWORK, "no LCM server at " + host + ":" + port + " (" + reason +
                                            "); start one there (`java lcm.lcm.TCPService " + port +
                                            "`), or give a udpm URL, which needs none");
}

/// liblcm prints by itself where a file cannot be made.
void check_writable(const Url& url) {
  const int file = open(url.address.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  const int reason = errno;
  if (file >= 0) {
    close(file);
    return;
  }
  throw LcmError(UNISIM_LCM_NO_NETWORK, url.address + ": cannot be written (" +
                                            std::strerror(reason) + "); give a file that can");
}

int64_t read_limit(const char* path) {
  std::ifstream file(path);
  int64_t bytes = 0;
  return file >> bytes ? bytes : 0;
}

}  // namespace

Url parse_url(const char* url, Direction direction) {
  Url out;
  out.text = url != nullptr && *url != '\0' ? url : UNISIM_LCM_DEFAULT_URL;
  const size_t colon = out.text.find("://");
  if (colon == std::string::npos) {
    refuse(out, std::string("is none: give one such as ") + UNISIM_LCM_DEFAULT_URL);
  }
  out.provider = out.text.substr(0, colon);
  const size_t question = std::min(out.text.find('?'), out.text.size());
  if (question > colon + 3) out.address = out.text.substr(colon + 3, question - colon - 3);
  const bool known = out.provider == "udpm" || out.provider == "tcpq" || out.provider == "file";
  if (!known) {
    refuse(out, "'" + out.provider + "' is not known here: give udpm, tcpq or file");
  }
  const bool writes = take_options(out.text.substr(std::min(question + 1, out.text.size())), &out);
  if (out.provider == "udpm") multicast_address(out);
  if (out.provider == "file") check_file(out, direction, writes);
  return out;
}

void check_channel(const std::string& channel) {
  if (!channel.empty() && channel.size() <= LCM_MAX_CHANNEL_NAME_LENGTH &&
      channel.find_first_of("\\^$.[]|()?*+{}") == std::string::npos) {
    return;
  }
  throw LcmError(UNISIM_LCM_BAD_CONFIG,
                 "channel '" + channel + "': give the name of one channel, at most 63 characters");
}

LcmPtr open_network(const Url& url) {
  if (url.provider == "udpm") check_route(url);
  if (url.provider == "tcpq") check_server(url);
  if (url.provider == "file") check_writable(url);
  errno = 0;
  LcmPtr handle(lcm_create(url.text.c_str()));
  if (handle == nullptr) {
    const std::string reason = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
    throw LcmError(UNISIM_LCM_NO_NETWORK, url.text + ": cannot be opened" + reason +
                                              "; see that its network or server " + "is there");
  }
  return handle;
}

ReceiveLimits receive_limits() {
  return {read_limit("/proc/sys/net/core/rmem_default"), read_limit("/proc/sys/net/core/rmem_max")};
}

}  // namespace unisim::lcm
