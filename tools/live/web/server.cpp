// SPDX-License-Identifier: MIT
// Serves the page of a live run and its events over HTTP.
#include "tools/live/web/server.hpp"

#include <arpa/inet.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "tools/common/failure.hpp"
#include "tools/live/scheduling.hpp"
#include "tools/live/web/page.hpp"

namespace unisim::live::web {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostWatchers = 4;
// One for each who watches, and two for those who ask for the page.
constexpr size_t kThreads = kMostWatchers + 2;
// One who says or takes nothing for so long is dropped, and one who takes so long for an event.
constexpr std::chrono::seconds kPatience(1);
constexpr std::chrono::seconds kEventPatience(3);
constexpr size_t kPart = 16384;
// Two seconds of events: what waits in the system is not new any more when it arrives.
constexpr int kSendBuffer = 1 << 19;
constexpr size_t kMostRequest = 4096;

/// Takes the same time whatever the first difference is.
bool same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    difference |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]);
  }
  return difference == 0;
}

void set_socket_options(socket_t socket) {
  // Not SO_REUSEPORT, the library's default: two programs would share the port and not know.
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
}

/// Ends the connections to our port, so that nobody waits for clients that say or take nothing. The
/// library does not know them; the system does.
void hang_up(int port) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", none)) {
    const int file = std::atoi(entry.path().filename().c_str());
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (getsockname(file, any, &size) != 0) continue;
    int here = -1;
    if (address.ss_family == AF_INET) here = reinterpret_cast<sockaddr_in*>(any)->sin_port;
    if (address.ss_family == AF_INET6) here = reinterpret_cast<sockaddr_in6*>(any)->sin6_port;
    if (here == htons(static_cast<uint16_t>(port))) shutdown(file, SHUT_RDWR);
  }
}

/// Where the address and port cannot be had. @param why errno
const char* what_to_do(int why) {
  if (why == EADDRINUSE) return "; another program has this port, give another one";
  if (why == EACCES) return "; ports below 1024 are the system's, give one above";
  return "; give an address of this machine (`ip addr` lists them), or 0.0.0.0 for all of them";
}

}  // namespace

class Server::Impl {
 public:
  Impl(Feed* feed, const Address& address, const std::string& token);
  ~Impl();

  int port() const { return port_; }

 private:
  httplib::Server::HandlerResponse admit(const httplib::Request& request,
                                         httplib::Response& response) const;
  void serve_events(httplib::Response& response);
  bool send(const std::string& event, httplib::DataSink* sink) const;

  Feed* feed_;
  std::string token_;
  httplib::Server http_;
  int port_ = 0;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

Server::Impl::Impl(Feed* feed, const Address& address, const std::string& token)
    : feed_(feed), token_(token) {
  http_.set_socket_options(set_socket_options);
  http_.set_keep_alive_max_count(1);
  http_.set_keep_alive_timeout(kPatience.count());
  http_.set_read_timeout(kPatience);
  http_.set_write_timeout(kPatience);
  http_.set_payload_max_length(kMostRequest);
  http_.set_tcp_nodelay(true);
  http_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  http_.set_default_headers({{"Cache-Control", "no-store"},
                             {"Referrer-Policy", "no-referrer"},
                             {"X-Content-Type-Options", "nosniff"},
                             {"X-Frame-Options", "DENY"},
                             {"Content-Security-Policy",
                              "default-src 'none'; style-src 'unsafe-inline'; script-src "
                              "'unsafe-inline'; img-src data:; connect-src 'self'"}});
  http_.set_pre_routing_handler(
      [this](const httplib::Request& request, httplib::Response& response) {
        return admit(request, response);
      });
  http_.Get("/", [](const httplib::Request&, httplib::Response& response) {
    response.set_content(kPage, "text/html; charset=utf-8");
  });
  http_.Get("/events", [this](const httplib::Request&, httplib::Response& response) {
    serve_events(response);
  });
  errno = 0;
  const bool any = address.port == 0;
  port_ = any ? http_.bind_to_any_port(address.host) : address.port;
  if (any ? port_ <= 0 : !http_.bind_to_port(address.host, address.port)) {
    const int why = errno;
    const std::string where = address.host + ":" + std::to_string(address.port);
    throw tools::Failure(tools::kExitLimit,
                         "--web " + where + ": " +
                             (why != 0 ? std::strerror(why) : "no such address here") +
                             what_to_do(why));
  }
  thread_ = std::thread([this] {
    give_way();
    http_.listen_after_bind();
  });
  // stop() has no effect before.
  while (!http_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

Server::Impl::~Impl() {
  ending_ = true;
  feed_->close();
  http_.stop();
  hang_up(port_);
  thread_.join();
}

httplib::Server::HandlerResponse Server::Impl::admit(const httplib::Request& request,
                                                     httplib::Response& response) const {
  const char* refusal = nullptr;
  if (!token_.empty()) {
    if (!same_secret(request.get_param_value("token"), token_)) {
      refusal = "unisim-live: add ?token= and the secret of --web-token to the address\n";
    }
  } else if (!names_this_machine(request.get_header_value("Host"))) {
    refusal = "unisim-live: open this page as http://localhost:PORT/\n";
  }
  if (refusal == nullptr) return httplib::Server::HandlerResponse::Unhandled;
  response.status = 403;
  response.set_content(refusal, "text/plain; charset=utf-8");
  return httplib::Server::HandlerResponse::Handled;
}

void Server::Impl::serve_events(httplib::Response& response) {
  if (feed_->watchers() >= kMostWatchers) {
    response.status = 503;
    response.set_content("unisim-live: others look already; close a page\n",
                         "text/plain; charset=utf-8");
    return;
  }
  const auto watcher = std::make_shared<Feed::Watcher>(feed_);
  response.set_content_provider("text/event-stream",
                                [this, watcher](size_t, httplib::DataSink& sink) {
                                  const auto event = watcher->next();
                                  return event != nullptr && send(*event, &sink);
                                });
}

/// In parts, so that a slow one is noticed. @return false when it is to be dropped
bool Server::Impl::send(const std::string& event, httplib::DataSink* sink) const {
  const Clock::time_point end = Clock::now() + kEventPatience;
  for (size_t done = 0; done < event.size();) {
    if (ending_ || Clock::now() > end) return false;
    const size_t part = std::min(kPart, event.size() - done);
    if (!sink->write(event.data() + done, part)) return false;
    done += part;
  }
  return true;
}

Server::Server(Feed* feed, const Address& address, const std::string& token)
    : impl_(std::make_unique<Impl>(feed, address, token)) {
  const bool v6 = address.host.find(':') != std::string::npos;
  url_ = "http://" + (v6 ? "[" + address.host + "]" : address.host) + ":" +
         std::to_string(impl_->port()) + "/";
}

Server::~Server() = default;

}  // namespace unisim::live::web
